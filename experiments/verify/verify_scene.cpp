#include "experiments/verify/verify_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>

#include "core/base/error.h"
#include "core/light_path/empty_caustic.h"
#include "experiments/base/step_progress.h"
#include "experiments/base/stopwatch.h"
#include "experiments/picture/metrics.h"
#include "experiments/run/caustic_ledger.h"
#include "experiments/run/caustic_survey.h"
#include "experiments/run/mesh_notes.h"
#include "experiments/run/methods.h"
#include "experiments/verify/cell_light.h"
#include "experiments/verify/light_audit.h"
#include "experiments/verify/picture_series.h"

namespace caustics::experiments {

namespace {

constexpr int most_width = 48;
/// Pictures of one setting: for a method as given, and with more work.
constexpr std::size_t least_seeds = 12;
constexpr std::size_t least_seeds_with_more_work = 6;
/// Seeds of the reference begin here, so that it shares no random numbers with a method.
constexpr std::uint64_t first_reference_seed = 1ULL << 32;

Agreement verdict(bool holds) { return holds ? Agreement::holds : Agreement::fails; }

MethodAsGiven with_defaults(const MethodDescription& method) { return {method.facts().name, {}}; }

/// The first unbiased method that serves the scene, at its defaults.
std::optional<MethodAsGiven> reference_for(const Scene& scene) {
    for (const MethodDescription* each : all_methods()) {
        if (!each->facts().is_unbiased) continue;
        MethodAsGiven method = with_defaults(*each);
        if (!why_unsupported(scene, method.method)) return method;
    }
    return {};
}

std::vector<MethodAsGiven> methods_asked(const std::vector<MethodAsGiven>& named) {
    for (const MethodAsGiven& each : named)
        if (!each.method.facts().has_caustic)
            throw InputError(fmt::format("--method {}: has no caustic to check", each.method.name));
    if (!named.empty()) return named;
    std::vector<MethodAsGiven> all;
    for (const MethodDescription* each : all_methods())
        if (each->facts().has_caustic) all.push_back(with_defaults(*each));
    return all;
}

/// At most so wide; with strata in the pixel, since what is checked is the method and not the sampler.
SceneDesc made_small(SceneDesc desc, int samples_per_pixel) {
    Camera& camera = desc.camera;
    const int width = std::clamp(camera.width, CellLight::columns, most_width);
    camera.height = std::max(CellLight::rows, width * camera.height / camera.width);
    camera.width = width;
    const int split_depth = desc.sampling.split_depth;
    desc.sampling = PixelSampling{};
    desc.sampling.split_depth = split_depth;
    desc.sampling.sample_count = samples_per_pixel;
    const int across = static_cast<int>(std::lround(std::sqrt(samples_per_pixel)));
    desc.sampling.stratified = across * across == samples_per_pixel;
    return desc;
}

bool same_bits(const Film& a, const Film& b) {
    return std::ranges::equal(a.planes(), b.planes(), [](const Plane& x, const Plane& y) {
        return x.channel == y.channel && x.values == y.values;
    });
}

bool same_light(const std::vector<Film>& a, const std::vector<Film>& b) {
    return same_bits(a.front(), b.front());
}

/// What errors that are too large would take.
std::string seeds_wanted(const CellGap& gap, std::uint64_t seeds, double excess_of_truth,
                         std::uint64_t reference_seeds) {
    const auto enough = [](std::uint64_t n, double excess) {
        return static_cast<std::uint64_t>(std::ceil(static_cast<double>(n) * excess * excess));
    };
    return fmt::format(
        "the standard error is above {:.1f} % (in cells {:.1f} %, here up to {:.1f} %): {} seeds "
        "of the method and {} of the reference would do (--seconds, or more --spp)",
        100 * whole_limit.largest_error(), 100 * cell_limit().largest_error(),
        100 * gap.largest_cell_error, enough(seeds, gap.excess_of_found),
        enough(reference_seeds, excess_of_truth));
}

class SceneVerifier {
public:
    SceneVerifier(SceneDesc desc, const VerifySettings& settings)
        : desc_(made_small(std::move(desc), settings.run.samples_per_pixel)),
          scene_(desc_),
          options_(settings.run),
          seconds_(settings.seconds),
          methods_(methods_asked(settings.methods)),
          reference_(reference_for(scene_)) {
        if (!settings.methods.empty()) require_served();
    }

    SceneReport run() {
        StepProgress progress(2 + methods_.size() + 2 * compared_count());
        for (const std::string& note : mesh_notes(scene_)) add("mesh", {}, note);
        progress.begin("account of the light");
        audit();
        look_for_the_caustic();
        progress.end("done");
        for (const MethodAsGiven& method : methods_) {
            progress.begin(method.method.name + " by threads");
            check_threads(method, progress);
            progress.expect_later(Eta(comparing(served_).seconds, true));
            progress.end("done");
        }
        compare(progress);
        return std::move(report_);
    }

private:
    /// Methods that are asked for by name: nothing would be checked of one that cannot serve. Where no
    /// light can make a caustic, the report says why.
    void require_served() const {
        if (why_nothing_is_aimed(scene_)) return;
        for (const MethodAsGiven& each : methods_)
            if (const auto reason = why_unsupported(scene_, each.method))
                throw UnsupportedScene(*reason);
    }

    bool is_compared(const MethodAsGiven& method) const {
        return reference_ && reference_->method.name != method.method.name &&
               !why_nothing_is_aimed(scene_) && !why_unsupported(scene_, method.method);
    }

    std::size_t compared_count() const {
        return static_cast<std::size_t>(std::ranges::count_if(
            methods_, [&](const MethodAsGiven& each) { return is_compared(each); }));
    }

    void add(std::string what, std::optional<Agreement> result, std::string detail) {
        report_.findings.push_back({std::move(what), result, std::move(detail)});
    }

    void audit() {
        for (const LightAccount& account : audit_lights(desc_, most_bounces)) {
            if (!account.nothing_aimed.empty()) {
                add("light: " + account.light, {}, account.nothing_aimed);
                continue;
            }
            add("light: " + account.light, verdict(account.holds()),
                fmt::format("sent towards casters {:.4g} W = met none {:.4g} + escaped {:.4g} + "
                            "absorbed {:.4g} + on black sides {:.4g} + cut off {:.4g} + arrived "
                            "{:.4g} (by branches {:.4g}, error {:.2g})",
                            account.sent, account.missed, account.escaped, account.absorbed,
                            account.on_black_side, account.depth_limited, account.arrived,
                            account.arrived_by_branches,
                            std::hypot(account.arrived_error, account.branches_error)));
        }
    }

    /// From the light to the camera, up to where it ends.
    void look_for_the_caustic() {
        std::string casters;
        for (const std::uint32_t i : scene_.casters())
            casters += (casters.empty() ? "" : ", ") + scene_.shapes()[i].name;
        add("caustic: casters", {}, casters.empty() ? "none" : casters);
        if (const auto reason = why_nothing_is_aimed(scene_)) {
            add("caustic: light towards them", {}, "no caustic: " + *reason);
            return;
        }
        const CausticSurvey survey = survey_caustic(scene_, most_bounces);
        if (survey.counts.stored == 0) {
            add("caustic: light from them", {},
                "no caustic: " + why_nothing_arrives(survey.counts));
            return;
        }
        add("caustic: light from them", {},
            fmt::format("{} of {} light paths arrive on receivers", survey.counts.stored,
                        survey.counts.emitted));
        add("caustic: seen", {},
            survey.seen > 0
                ? fmt::format("{} of them where the camera looks straight at", survey.seen)
                : "not straight: " + why_unseen(survey));
    }

    void check_threads(const MethodAsGiven& given, StepProgress& progress) {
        const Method& method = given.method;
        if (const auto reason = why_unsupported(scene_, method)) {
            add("threads: " + method.name, {}, "cannot serve the scene: " + *reason);
            return;
        }
        RunOptions options = options_;
        options.threads = 1;
        options.progress = [&](double) { progress.share(0); };
        const Stopwatch watch;
        const Film alone = picture_of(scene_, method, options, [&](const BuildReport& report) {
            account_for(method, report);
        });
        seconds_of_picture_[method.name] = watch.total().wall;
        options.progress = [&](double) { progress.share(0.5); };
        bool same = true;
        for (options.threads = 2; options.threads <= std::max(2, options_.threads);
             options.threads = std::max(options.threads + 1, options_.threads)) {
            const Stopwatch again;
            const Film other = picture_of(scene_, method, options);
            if (options_.threads > 1) seconds_of_picture_[method.name] = again.total().wall;
            same = same && same_bits(alone, other);
        }
        add("threads: " + method.name, verdict(same),
            same ? "the same picture with one and more" : "pictures with one and more differ");
        if (is_compared(given)) served_.push_back(given);
    }

    /// The light that a biased method sent, and what became of it. An unbiased one loses none.
    void account_for(const Method& method, const BuildReport& report) {
        if (method.facts().is_unbiased) return;
        const auto ledger = caustic_ledger(scene_, method, report);
        if (!ledger) return;
        add("light of " + method.name, {}, balance_text(ledger->light));
        for (const std::string& note : notes_on_light(method, report, *ledger))
            add("light of " + method.name, {}, note);
    }

    /// Seconds that the least number of pictures of a method take, as far as one was timed.
    std::optional<double> seconds_of(const MethodAsGiven& method) const {
        const auto found = seconds_of_picture_.find(method.method.name);
        if (found == seconds_of_picture_.end()) return {};
        return least_seeds * found->second;
    }

    /// What comparing these methods takes, at least: which will want more seeds or work is not known.
    Eta comparing(std::span<const MethodAsGiven> methods) const {
        Eta eta(0, true);
        for (const MethodAsGiven& method : methods) eta.seconds += seconds_of(method).value_or(0);
        return eta;
    }

    void compare(StepProgress& progress) {
        if (why_nothing_is_aimed(scene_)) return;
        if (!reference_) {
            add("reference", {}, "no unbiased method can serve the scene");
            return;
        }
        progress.expect_later(comparing(served_));
        progress.begin("reference", seconds_of(*reference_));
        RunOptions options = options_;
        options.seed += first_reference_seed;
        PictureSeries truth(scene_, reference_->method, options);
        const auto light = [&] {
            return cell_light(truth.films(),
                              reached_pixels(truth.films().front(), truth.films().front()));
        };
        truth.fill({least_seeds, seconds_}, [&] { return excess_of_truth(light()); }, progress);
        progress.end("done");
        const PixelMask counted = reached_pixels(truth.films().front(), truth.films().front());
        add("reference", {},
            fmt::format("{}, {} seeds, {:.0f} % of the pixels reached", reference_->method.name,
                        truth.count(), 100 * fraction(counted)));
        for (std::size_t i = 0; i < served_.size(); ++i) {
            progress.expect_later(comparing(std::span(served_).subspan(i + 1)));
            compare(served_[i], truth, progress);
        }
    }

    /// A series with its gap to the reference, as large as the standard error asks.
    struct Compared {
        PictureSeries series;
        CellGap gap = {};
    };
    Compared compared(const MethodAsGiven& given, const PictureSeries& truth, std::size_t least,
                      StepProgress& progress) const {
        Compared found{PictureSeries(scene_, given.method, options_)};
        const auto measure = [&] {
            const PixelMask counted =
                reached_pixels(found.series.films().front(), truth.films().front());
            found.gap =
                gap(cell_light(found.series.films(), counted), cell_light(truth.films(), counted));
            return found.gap.excess_of_found;
        };
        found.series.fill({least, seconds_}, measure, progress);
        measure();
        return found;
    }

    void compare(const MethodAsGiven& given, const PictureSeries& truth, StepProgress& progress) {
        const std::string& name = given.method.name;
        const std::string what = "against the reference: " + name;
        progress.begin(name, seconds_of(given));
        const Compared first = compared(given, truth, least_seeds, progress);
        progress.end("done");
        progress.begin(name + " with more work");
        std::string text = first.gap.text();
        Agreement agreement = Agreement::holds;
        if (!first.gap.can_judge())
            agreement = Agreement::unsure;
        else if (!first.gap.is_within())
            agreement = with_more_work(given, first, truth, progress, text);
        if (agreement == Agreement::unsure) {
            const PixelMask counted =
                reached_pixels(first.series.films().front(), truth.films().front());
            text += "; " + seeds_wanted(first.gap, first.series.count(),
                                        excess_of_truth(cell_light(truth.films(), counted)),
                                        truth.count());
        }
        progress.end(word(agreement));
        add(what, agreement, text);
    }

    /// Tries a method that is off with 4 and 16 times the work, and adds to `text` how that changes the light.
    Agreement with_more_work(const MethodAsGiven& given, const Compared& first,
                             const PictureSeries& truth, StepProgress& progress,
                             std::string& text) const {
        if (given.method.facts().is_unbiased || first.gap.is_black) return Agreement::fails;
        std::array<Difference, work_steps> whole = {first.gap.whole};
        std::array<Difference, work_steps> cells = {first.gap.worst_cell};
        for (std::size_t step = 1; step < work_steps; ++step) {
            const int factor = step == 1 ? work_factor : work_factor * work_factor;
            try {
                const MethodAsGiven more = given.with_more_work(factor);
                const Compared found = compared(more, truth, least_seeds_with_more_work, progress);
                text += fmt::format("; with {} {}", more.work_text(), found.gap.text());
                if (same_light(found.series.films(), first.series.films())) {
                    text += ", the same picture";
                    return Agreement::fails;
                }
                whole[step] = found.gap.whole;
                cells[step] = found.gap.worst_cell;
            } catch (const InputError& refused) {
                text += fmt::format("; {}", refused.what());
                return Agreement::fails;
            }
        }
        return judged(whole, cells, text);
    }

    static Agreement judged(const std::array<Difference, work_steps>& whole,
                            const std::array<Difference, work_steps>& cells, std::string& text) {
        if (!std::ranges::all_of(whole,
                                 [](const Difference& d) { return whole_limit.is_known(d); })) {
            text += "; the standard errors are too large to tell how the difference changes";
            return Agreement::unsure;
        }
        const Convergence of_whole = convergence(whole, whole_limit);
        const Convergence of_cells = convergence(cells, cell_limit());
        const auto is_small = [](const auto& differences, const Limit& limit) {
            return std::ranges::all_of(
                differences, [&](const Difference& d) { return std::abs(d.value) <= limit.share; });
        };
        text += fmt::format("; whole picture: {}; worst cell: order {:.2f}", of_whole.text(),
                            of_cells.order);
        const bool converges = (of_whole.shrinks || is_small(whole, whole_limit)) &&
                               (of_cells.shrinks || is_small(cells, cell_limit()));
        return converges ? Agreement::converges : Agreement::fails;
    }

    SceneDesc desc_;
    Scene scene_;
    RunOptions options_;
    double seconds_;
    std::vector<MethodAsGiven> methods_;
    std::optional<MethodAsGiven> reference_;
    std::vector<MethodAsGiven>
        served_;  ///< methods that are compared, once their threads are checked
    std::map<std::string, double> seconds_of_picture_;  ///< with all threads
    SceneReport report_;
};

}  // namespace

bool SceneReport::holds(bool allow_converging) const {
    return std::ranges::all_of(findings, [&](const Finding& each) {
        return !each.verdict || *each.verdict == Agreement::holds ||
               (allow_converging && *each.verdict == Agreement::converges);
    });
}

std::string SceneReport::text() const {
    std::string text;
    for (const Finding& each : findings)
        text += fmt::format("{:<9} {:<38} {}\n", each.verdict ? word(*each.verdict) : "-",
                            each.what, each.detail);
    if (holds()) return text + "verify: all holds\n";
    text += "verify: not all holds:";
    for (const Agreement agreement : {Agreement::converges, Agreement::fails, Agreement::unsure}) {
        const auto count = std::ranges::count(findings, agreement, &Finding::verdict);
        if (count > 0) text += fmt::format(" {} {}", count, word(agreement));
    }
    return text + "\n";
}

SceneReport verify_scene(SceneFile file, const VerifySettings& settings) {
    return SceneVerifier(std::move(file.desc), settings).run();
}

}  // namespace caustics::experiments
