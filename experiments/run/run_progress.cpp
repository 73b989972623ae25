#include "experiments/run/run_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace caustics::experiments {

void RunEta::begin(std::string_view phase, double now) {
    (rendering_ ? render_seconds_ : build_seconds_) += now - begun_;
    const bool rendering = phase == "render";
    if (rendering_ && !rendering) built_ = build_seconds_;
    if (rendering && !rendering_) ++renders_;
    rendering_ = rendering;
    begun_ = now;
}

std::optional<Eta> RunEta::at(double share, double now) const {
    const double in_phase = now - begun_;
    const double passes_left = passes_ - renders_;
    if (rendering_) {
        if (!(share > 0)) return {};
        return Eta((render_seconds_ + in_phase) * (1 - share) / share +
                   passes_left * build_seconds_ / renders_);
    }
    if (renders_ == 0) {
        if (!(share > 0)) return {};
        return Eta(in_phase * (1 - share) / share, true);
    }
    const double build = built_ / renders_;
    const double of_this = std::max(0.0, build - (build_seconds_ - built_ + in_phase));
    return Eta(of_this + (passes_left - 1) * build + passes_left * render_seconds_ / renders_);
}

std::string phase_text(const std::string& phase, double share,
                       const std::optional<Eta>& remaining) {
    constexpr int width = 20;
    const auto full = static_cast<int>(std::floor(width * std::clamp(share, 0.0, 1.0)));
    return fmt::format("{} [{:#<{}}{:.<{}}] {:.0f} %, ETA {}", phase, "", full, "", width - full,
                       100 * share, eta_text(remaining));
}

RunProgress::RunProgress(RunOptions& options, int passes) : passes_(passes), eta_(passes) {
    options.begin_phase = [this](std::string_view phase) { begin(phase); };
    options.progress = [this](double done) { share(done); };
}

std::string RunProgress::shown_phase() const {
    return passes_ > 1 ? fmt::format("{}/{} {}", eta_.pass(), passes_, phase_) : phase_;
}

void RunProgress::begin(std::string_view phase) {
    const std::lock_guard lock(showing_);
    phase_ = phase;
    eta_.begin(phase, seconds_since(begun_));
    last_share_ = 0;
    // A phase may say nothing for a while, or at all.
    if (line_.is_on_terminal()) line_.show(shown_phase() + " ...");
}

void RunProgress::share(double done) {
    if (!line_.is_due()) return;
    const std::unique_lock lock(showing_, std::try_to_lock);
    if (!lock.owns_lock() || !line_.is_due()) return;
    const double now = seconds_since(begun_);
    // Shares that fall far are those of another stretch of work under the same name; threads may tell theirs late.
    if (done < last_share_ / 2) eta_.begin(phase_, now);
    last_share_ = done;
    line_.show(phase_text(shown_phase(), done, eta_.at(done, now)));
}

}  // namespace caustics::experiments
