#include "experiments/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "experiments/interrupt.h"

namespace caustics {

namespace {

constexpr std::chrono::milliseconds terminal_interval{200};
constexpr std::chrono::seconds plain_interval{15};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::string clock_text(double seconds) {
    const long whole = std::lround(seconds);
    if (whole >= 3600)
        return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

Progress::Progress(std::size_t steps)
    : steps_(steps),
      terminal_(isatty(fileno(stderr)) == 1),
      start_(Clock::now()),
      step_start_(start_),
      last_drawn_(start_) {}

Progress::~Progress() { clear(); }

void Progress::clear() {
    if (terminal_) fmt::print(stderr, "\r\033[K");
}

std::string Progress::eta(double done) const {
    const double share = (static_cast<double>(finished_) + done) / static_cast<double>(steps_);
    if (share <= 0) return "-";
    return clock_text(seconds_since(start_) * (1 - share) / share);
}

void Progress::draw(double done) {
    const std::string line = fmt::format("[{}/{}] {} {:.0f} %, ETA {}", finished_ + 1, steps_,
                                         what_, 100 * done, eta(done));
    if (terminal_)
        fmt::print(stderr, "\r\033[K{}", line.substr(0, 150));
    else
        fmt::print(stderr, "{}\n", line);
    std::fflush(stderr);
    last_drawn_ = Clock::now();
}

void Progress::begin(const std::string& what) {
    const std::scoped_lock lock(mutex_);
    what_ = what;
    step_start_ = last_drawn_ = Clock::now();
    if (terminal_) draw(0);
}

void Progress::share(double done) {
    throw_if_interrupted();
    const std::scoped_lock lock(mutex_);
    const auto since = Clock::now() - last_drawn_;
    if (since < (terminal_ ? Clock::duration(terminal_interval) : Clock::duration(plain_interval)))
        return;
    draw(done);
}

void Progress::end(const std::string& result) {
    const std::scoped_lock lock(mutex_);
    ++finished_;
    clear();
    fmt::print(stderr, "[{}/{}] {}: {}, {:.2f} s, ETA {}\n", finished_, steps_, what_, result,
               seconds_since(step_start_), eta(0));
}

}  // namespace caustics
