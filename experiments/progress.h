#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

namespace caustics {

/// Tells on stderr how far a long job of equal steps is: one line kept up to date with an ETA on a
/// terminal, plain lines otherwise. Thread-safe.
class Progress {
public:
    explicit Progress(std::size_t steps);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// A step begins.
    void begin(const std::string& what);
    /// The done share of the current phase of the step. Throws Interrupted when the user asked to
    /// stop.
    void share(double done);
    /// The step is over; `result` ends its line.
    void end(const std::string& result);

private:
    using Clock = std::chrono::steady_clock;

    void draw(double done);
    void clear();
    std::string eta(double done) const;

    std::mutex mutex_;
    std::size_t steps_;
    std::size_t finished_ = 0;
    bool terminal_;
    std::string what_;
    Clock::time_point start_;
    Clock::time_point step_start_;
    Clock::time_point last_drawn_;
};

/// "1:02:03" or "2:03" for a number of seconds.
std::string clock_text(double seconds);

}  // namespace caustics
