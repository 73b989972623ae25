#include "experiments/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "experiments/files.h"

namespace caustics {

namespace {

constexpr std::chrono::milliseconds terminal_interval{200};
constexpr std::chrono::seconds plain_interval{15};

std::string eta(std::optional<double> remaining) {
    return remaining ? clock_text(*remaining) : "-";
}

}  // namespace

std::string clock_text(double seconds) {
    const long whole = std::lround(seconds);
    if (whole >= 3600)
        return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

Progress::Progress(std::size_t steps, std::size_t done)
    : steps_(steps),
      finished_(done),
      terminal_(isatty(fileno(stderr)) == 1),
      last_shown_(terminal_ ? Clock::time_point() : Clock::now()) {}

Progress::~Progress() { clear(); }

void Progress::clear() {
    if (terminal_) write_stderr("\r\033[K");
}

bool Progress::is_due() const {
    return Clock::now() - last_shown_ >=
           (terminal_ ? Clock::duration(terminal_interval) : Clock::duration(plain_interval));
}

void Progress::show(const std::string& what, double share, std::optional<double> remaining) {
    const std::string line = fmt::format("[{}/{}] ETA {}, {} {:.0f} %", finished_, steps_,
                                         eta(remaining), what, 100 * share);
    clear();
    if (terminal_)
        write_stderr(line.substr(0, 150));
    else
        write_stderr(line + "\n");
    last_shown_ = Clock::now();
}

void Progress::end(const std::string& result, bool notable, std::optional<double> remaining) {
    ++finished_;
    if (!terminal_ || notable)
        note(fmt::format("[{}/{}] {}, ETA {}", finished_, steps_, result, eta(remaining)));
}

void Progress::note(const std::string& line) {
    clear();
    write_stderr(line + "\n");
}

}  // namespace caustics
