#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

#include "experiments/base/status_line.h"

namespace caustics::experiments {

/// What is known of the time that a job will still take.
struct Eta {
    Eta(double all, bool more_to_come = false) : seconds(all), at_least(more_to_come) {}
    double seconds;
    bool at_least;  ///< some of the work is not known yet
};

/// Tells on stderr how far a job of many steps is: on a terminal one line kept up to date, with an
/// ETA over the whole job, and a line that stays for each step worth one; elsewhere a line a step.
class Progress {
public:
    /// `done` of the `steps` were done before.
    Progress(std::size_t steps, std::size_t done) : steps_(steps), finished_(done) {}

    /// Whether it is time for show(). From any thread.
    bool is_due() const { return line_.is_due(); }
    /// What is at work now, its done share, and what the whole job will still take.
    void show(const std::string& what, double share, const std::optional<Eta>& remaining);
    /// A step is over; on a terminal its line stays only when it is `notable`.
    void end(const std::string& result, bool notable, const std::optional<Eta>& remaining);
    /// A line that stays.
    void note(const std::string& line) { line_.note(line); }

private:
    std::size_t steps_;
    std::size_t finished_;
    StatusLine line_;
};

/// On the clock that never goes back [s].
double seconds_since(std::chrono::steady_clock::time_point time);

/// "0:12", "at least 0:12", or "-" where nothing is known.
std::string eta_text(const std::optional<Eta>& remaining);

/// "1:02:03" or "2:03" for a number of seconds.
std::string clock_text(double seconds);

}  // namespace caustics::experiments
