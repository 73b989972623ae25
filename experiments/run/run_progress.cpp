#include "experiments/run/run_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/base/progress.h"

namespace caustics::experiments {

std::string phase_text(const std::string& phase, double share, double seconds) {
    constexpr int width = 20;
    const auto full = static_cast<int>(std::floor(width * std::clamp(share, 0.0, 1.0)));
    const std::string eta = share > 0 ? clock_text(seconds * (1 - share) / share) : "-";
    return fmt::format("{} [{:#<{}}{:.<{}}] {:.0f} %, phase ETA {}", phase, "", full, "",
                       width - full, 100 * share, eta);
}

RunProgress::RunProgress(RunOptions& options) {
    options.begin_phase = [this](std::string_view phase) { begin(phase); };
    options.progress = [this](double done) { share(done); };
}

void RunProgress::begin(std::string_view phase) {
    const std::lock_guard lock(showing_);
    phase_ = phase;
    begun_ = std::chrono::steady_clock::now();
    last_share_ = 0;
    // A phase may say nothing for a while, or at all.
    if (line_.is_on_terminal()) line_.show(phase_ + " ...");
}

void RunProgress::share(double done) {
    if (!line_.is_due()) return;
    const std::unique_lock lock(showing_, std::try_to_lock);
    if (!lock.owns_lock() || !line_.is_due()) return;
    const auto now = std::chrono::steady_clock::now();
    // Shares that fall are those of another stretch of work under the same name.
    if (done < last_share_) begun_ = now;
    last_share_ = done;
    line_.show(phase_text(phase_, done, std::chrono::duration<double>(now - begun_).count()));
}

}  // namespace caustics::experiments
