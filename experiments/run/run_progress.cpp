#include "experiments/run/run_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace caustics::experiments {

namespace {

// By the plan until so much of it is done; then by what that took.
constexpr double known_part = 0.05;

}  // namespace

RunEta::RunEta(int passes, std::map<std::string, double> plan)
    : passes_(passes), plan_(std::move(plan)) {
    for (const auto& [phase, seconds] : plan_) all_ += seconds;
}

void RunEta::begin(std::string_view phase, double now) {
    (rendering_ ? render_seconds_ : build_seconds_) += now - begun_;
    const bool rendering = phase == "render";
    if (rendering_ && !rendering) {
        built_ = build_seconds_;
        over_.clear();
    } else if (!phase_.empty() && phase_ != phase) {
        over_.push_back(phase_);
    }
    if (rendering && !rendering_) ++renders_;
    rendering_ = rendering;
    phase_ = phase;
    begun_ = now;
}

double RunEta::planned(const std::string& phase) const {
    const auto found = plan_.find(phase);
    return found == plan_.end() ? 0 : found->second;
}

double RunEta::planned_until(double share) const {
    // Rendering begins when all else is over.
    if (rendering_) return all_ - (1 - share) * planned(phase_);
    double until = share * planned(phase_);
    for (const std::string& phase : over_) until += planned(phase);
    return std::min(until, all_);
}

double RunEta::done(double share) {
    const double passes_over = rendering_ ? renders_ - 1 : renders_;
    // The share of rendering is that of all passes.
    const double in_phase = rendering_ ? passes_ * share - passes_over : share;
    double own = 0;
    if (all_ > 0)
        own = planned_until(in_phase) / all_;
    else if (rendering_)
        own = (1 + in_phase) / 2;
    else
        own = (1 - std::exp2(-static_cast<double>(over_.size()) - in_phase)) / 2;
    done_ = std::max(done_, std::clamp((passes_over + own) / passes_, 0.0, 1.0));
    return done_;
}

std::optional<Eta> RunEta::at(double share, double now) const {
    const double in_phase = now - begun_;
    const double passes_left = passes_ - renders_;
    if (rendering_) {
        if (!(share > 0)) return {};
        return Eta((render_seconds_ + in_phase) * (1 - share) / share +
                   passes_left * build_seconds_ / renders_);
    }
    if (all_ > 0) {
        const double until = planned_until(share);
        return Eta((all_ - until) * (until > known_part * all_ ? now / until : 1));
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

RunProgress::RunProgress(RunOptions& options, int passes,
                         const std::function<std::map<std::string, double>()>& plan)
    : passes_(passes), eta_(passes) {
    if (plan && passes == 1 && line_.is_on_terminal()) {
        line_.show("planning ...");
        eta_ = RunEta(passes, plan());
        begun_ = std::chrono::steady_clock::now();
    }
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
    const std::optional<Eta> remaining = eta_.at(done, now);
    line_.show(phase_text(shown_phase(), eta_.done(done), remaining));
}

}  // namespace caustics::experiments
