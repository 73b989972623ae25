#include "experiments/base/progress.h"

#include <fmt/format.h>

#include <cmath>

namespace caustics::experiments {

double seconds_since(std::chrono::steady_clock::time_point time) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - time).count();
}

std::string eta_text(const std::optional<Eta>& remaining) {
    if (!remaining) return "-";
    return (remaining->at_least ? "at least " : "") + clock_text(remaining->seconds);
}

std::string clock_text(double seconds) {
    const long whole = std::lround(seconds);
    if (whole >= 3600)
        return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

void Progress::show(const std::string& what, double share, const std::optional<Eta>& remaining) {
    // What the line's end loses on a narrow terminal is a part of the name.
    line_.show(fmt::format("[{}/{}] ETA {}, {:.0f} % {}", finished_, steps_, eta_text(remaining),
                           100 * share, what));
}

void Progress::end(const std::string& result, bool notable, const std::optional<Eta>& remaining) {
    ++finished_;
    if (!line_.is_on_terminal() || notable)
        note(fmt::format("[{}/{}] {}, ETA {}", finished_, steps_, result, eta_text(remaining)));
}

}  // namespace caustics::experiments
