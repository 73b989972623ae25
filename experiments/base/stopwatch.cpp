#include "experiments/base/stopwatch.h"

#include <sys/resource.h>

#include <ctime>

namespace caustics::experiments {

Seconds& Seconds::operator+=(const Seconds& other) {
    wall += other.wall;
    cpu += other.cpu;
    return *this;
}

Seconds operator-(const Seconds& a, const Seconds& b) { return {a.wall - b.wall, a.cpu - b.cpu}; }

namespace {

double own_cpu_seconds() {
    timespec cpu{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
    return static_cast<double>(cpu.tv_sec) + 1e-9 * static_cast<double>(cpu.tv_nsec);
}

}  // namespace

double cpu_seconds_used() {
    rusage children{};
    getrusage(RUSAGE_CHILDREN, &children);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return own_cpu_seconds() + seconds(children.ru_utime) + seconds(children.ru_stime);
}

Seconds Stopwatch::now() {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now().time_since_epoch();
    return {wall.count(), own_cpu_seconds()};
}

Stopwatch::Stopwatch() : start_(now()), begun_(start_) {}

void Stopwatch::end_phase(const Seconds& at) {
    if (!current_.empty()) phases_[current_] += at - begun_;
    begun_ = at;
    current_.clear();
}

void Stopwatch::begin(std::string_view phase) {
    const std::scoped_lock lock(mutex_);
    end_phase(now());
    current_ = phase;
}

void Stopwatch::stop() {
    const std::scoped_lock lock(mutex_);
    end_phase(now());
}

Seconds Stopwatch::of(const std::string& phase) const {
    const std::scoped_lock lock(mutex_);
    const auto found = phases_.find(phase);
    return found == phases_.end() ? Seconds{} : found->second;
}

Seconds Stopwatch::of_stage(const std::string& stage) const {
    const std::scoped_lock lock(mutex_);
    Seconds sum;
    for (const auto& [phase, seconds] : phases_)
        if (phase == stage || phase.starts_with(stage + "/")) sum += seconds;
    return sum;
}

Seconds Stopwatch::worked() const {
    const std::scoped_lock lock(mutex_);
    Seconds sum;
    for (const auto& [name, seconds] : phases_) sum += seconds;
    return sum;
}

Seconds Stopwatch::total() const { return now() - start_; }

}  // namespace caustics::experiments
