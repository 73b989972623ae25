#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace caustics {

/// Tells on stderr how far a long job is: on a terminal one line kept up to date, with an ETA over
/// the whole job, and a line that stays for each step worth one; elsewhere a line a step.
class Progress {
public:
    /// `done` of the `steps` were done before.
    Progress(std::size_t steps, std::size_t done);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Whether it is time for show().
    bool is_due() const;
    /// What is at work now, its done share, and the seconds that the whole job will still take.
    void show(const std::string& what, double share, std::optional<double> remaining);
    /// A step is over; on a terminal its line stays only when it is `notable`.
    void end(const std::string& result, bool notable, std::optional<double> remaining);
    /// A line that stays.
    void note(const std::string& line);

private:
    using Clock = std::chrono::steady_clock;

    void clear();

    std::size_t steps_;
    std::size_t finished_;
    bool terminal_;
    Clock::time_point last_shown_;
};

/// "1:02:03" or "2:03" for a number of seconds.
std::string clock_text(double seconds);

}  // namespace caustics
