#include "experiments/base/stopwatch.h"

#include <ctime>

namespace caustics::experiments {

Seconds& Seconds::operator+=(const Seconds& other) {
    wall += other.wall;
    cpu += other.cpu;
    return *this;
}

Seconds operator-(const Seconds& a, const Seconds& b) { return {a.wall - b.wall, a.cpu - b.cpu}; }

Seconds Stopwatch::now() {
    timespec cpu{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now().time_since_epoch();
    return {wall.count(),
            static_cast<double>(cpu.tv_sec) + 1e-9 * static_cast<double>(cpu.tv_nsec)};
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

Seconds Stopwatch::worked() const {
    const std::scoped_lock lock(mutex_);
    Seconds sum;
    for (const auto& [name, seconds] : phases_) sum += seconds;
    return sum;
}

Seconds Stopwatch::total() const { return now() - start_; }

}  // namespace caustics::experiments
