#include "experiments/verify/verify_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>

#include "core/base/error.h"
#include "core/light_path/empty_caustic.h"
#include "core/render/renderer.h"
#include "experiments/base/step_progress.h"
#include "experiments/base/stopwatch.h"
#include "experiments/picture/metrics.h"
#include "experiments/run/caustic_survey.h"
#include "experiments/run/mesh_notes.h"
#include "experiments/run/method.h"
#include "experiments/run/methods.h"
#include "experiments/verify/cell_light.h"
#include "experiments/verify/light_audit.h"

namespace caustics::experiments {

namespace {

using Verdict = Finding::Verdict;

constexpr int max_bounces = 16;
constexpr int width = 48;
constexpr std::uint64_t seeds = 12;
/// What a biased method may be off.
constexpr BiasAllowed allowed = {.in_all = 0.02, .in_cells = 0.1};
/// What it may be off in all, if more effort makes it less.
constexpr double most_while_shrinking = 0.1;

Verdict verdict(bool holds) { return holds ? Verdict::holds : Verdict::fails; }

Method with_effort(const MethodDescription& method, bool more = false) {
    const MethodFacts& facts = method.facts();
    return parse_method(facts.name, parameters_node(more ? facts.more_effort : facts.effort));
}

/// The first unbiased method that serves the scene; nullptr where there is none.
const MethodDescription* reference_for(const Scene& scene) {
    const auto serves = [&](const MethodDescription* each) {
        return each->facts().is_unbiased && !why_unsupported(scene, with_effort(*each));
    };
    const auto found = std::ranges::find_if(all_methods(), serves);
    return found == all_methods().end() ? nullptr : *found;
}

SceneDesc made_small(SceneDesc desc) {
    Camera& camera = desc.camera;
    camera.height = std::max(CellLight::rows, width * camera.height / camera.width);
    camera.width = width;
    desc.sampling = PixelSampling{};
    return desc;
}

Film picture(const Scene& scene, const Method& method, RunOptions options, std::uint64_t seed) {
    options.seed = seed;
    options.samples_per_pixel = scene.sampling().sample_count;
    const auto build_pass = [&](int pass) { return build(scene, method, options, pass); };
    return render(scene, {pass_count(method), build_pass}, options).film;
}

bool same_bits(const Film& a, const Film& b) {
    return std::ranges::equal(a.planes(), b.planes(), [](const Plane& x, const Plane& y) {
        return x.channel == y.channel && x.values == y.values;
    });
}

class SceneVerifier {
public:
    SceneVerifier(SceneDesc desc, const std::vector<std::string>& methods,
                  const RunOptions& options)
        : desc_(made_small(std::move(desc))), scene_(desc_), options_(options) {
        for (const MethodDescription* each : all_methods()) {
            const bool is_named = std::ranges::count(methods, each->facts().name) > 0;
            if (is_named && !each->facts().has_caustic)
                throw InputError(
                    fmt::format("--method {}: has no caustic to check", each->facts().name));
            if (is_named || (methods.empty() && each->facts().has_caustic))
                methods_.push_back(each);
        }
        if (!methods.empty()) require_served();
    }

    SceneReport run() {
        StepProgress progress(2 * methods_.size() + 2);
        for (const std::string& note : mesh_notes(scene_)) add("mesh", Verdict::told, note);
        progress.begin("account of the light");
        audit();
        look_for_the_caustic();
        progress.end("done");
        for (const MethodDescription* method : methods_) {
            progress.begin(method->facts().name + " by threads");
            check_threads(*method, progress);
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
        for (const MethodDescription* each : methods_)
            if (const auto reason = why_unsupported(scene_, with_effort(*each)))
                throw UnsupportedScene(*reason);
    }

    void add(std::string what, Verdict result, std::string detail) {
        report_.findings.push_back({std::move(what), result, std::move(detail)});
    }

    void audit() {
        for (const LightAccount& account : audit_lights(desc_, max_bounces)) {
            if (!account.nothing_aimed.empty()) {
                add("light: " + account.light, Verdict::told, account.nothing_aimed);
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
        add("caustic: casters", Verdict::told, casters.empty() ? "none" : casters);
        if (const auto reason = why_nothing_is_aimed(scene_)) {
            add("caustic: light towards them", Verdict::told, "no caustic: " + *reason);
            return;
        }
        const CausticSurvey survey = survey_caustic(scene_, max_bounces);
        if (survey.counts.stored == 0) {
            add("caustic: light from them", Verdict::told,
                "no caustic: " + why_nothing_arrives(survey.counts));
            return;
        }
        add("caustic: light from them", Verdict::told,
            fmt::format("{} of {} light paths arrive on receivers", survey.counts.stored,
                        survey.counts.emitted));
        add("caustic: seen", Verdict::told,
            survey.seen > 0
                ? fmt::format("{} of them where the camera looks straight at", survey.seen)
                : "not straight: " + why_unseen(survey));
    }

    /// A picture, while the progress of its step stays up to date.
    Film picture_of(const Method& method, RunOptions options, std::uint64_t seed,
                    StepProgress& progress, double share) const {
        options.progress = [&](double) { progress.share(share); };
        return picture(scene_, method, options, seed);
    }

    void check_threads(const MethodDescription& method, StepProgress& progress) {
        const std::string& name = method.facts().name;
        const Method configured = with_effort(method);
        if (const auto reason = why_unsupported(scene_, configured)) {
            add("threads: " + name, Verdict::told, "cannot serve the scene: " + *reason);
            return;
        }
        RunOptions options = options_;
        options.threads = 1;
        const Stopwatch watch;
        const Film alone = picture_of(configured, options, 1, progress, 0);
        seconds_of_picture_[name] = watch.total().wall;
        bool same = true;
        for (options.threads = 2; options.threads <= std::max(2, options_.threads);
             options.threads = std::max(options.threads + 1, options_.threads)) {
            const Stopwatch again;
            const Film other = picture_of(configured, options, 1, progress, 0.5);
            if (options_.threads > 1) seconds_of_picture_[name] = again.total().wall;
            same = same && same_bits(alone, other);
        }
        add("threads: " + name, verdict(same),
            same ? "the same picture with one and more" : "pictures with one and more differ");
        served_.push_back(&method);
    }

    std::vector<Film> films_of(const MethodDescription& method, bool more,
                               StepProgress& progress) const {
        std::vector<Film> films;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed)
            films.push_back(picture_of(with_effort(method, more), options_, seed, progress,
                                       static_cast<double>(seed - 1) / seeds));
        return films;
    }

    /// Seconds that the pictures of a method's first effort take, as far as one was timed.
    std::optional<double> seconds_of(const MethodDescription& method) const {
        const auto found = seconds_of_picture_.find(method.facts().name);
        if (found == seconds_of_picture_.end()) return {};
        return seeds * found->second;
    }

    /// What comparing these methods takes, at least: which will want more effort is not known.
    Eta comparing(std::span<const MethodDescription* const> methods) const {
        Eta eta(0);
        for (const MethodDescription* method : methods) {
            eta.seconds += seconds_of(*method).value_or(0);
            eta.at_least = eta.at_least || !method->facts().more_effort.empty();
        }
        return eta;
    }

    void compare(StepProgress& progress) {
        if (why_nothing_is_aimed(scene_)) return;
        const MethodDescription* const reference = reference_for(scene_);
        if (reference == nullptr) {
            add("reference", Verdict::told, "no unbiased method can serve the scene");
            return;
        }
        std::erase(served_, reference);
        progress.expect_later(comparing(served_));
        progress.begin("reference", seconds_of(*reference));
        const std::vector<Film> truth = films_of(*reference, false, progress);
        progress.end("done");
        const PixelMask counted = reached_pixels(truth.front(), truth.front());
        add("reference", Verdict::told,
            fmt::format("{}, {} seeds, {:.0f} % of the pixels reached", reference->facts().name,
                        seeds, 100 * fraction(counted)));
        for (std::size_t i = 0; i < served_.size(); ++i) {
            progress.expect_later(comparing(std::span(served_).subspan(i + 1)));
            progress.begin(served_[i]->facts().name, seconds_of(*served_[i]));
            compare(*served_[i], truth, progress);
            progress.end("done");
        }
    }

    void compare(const MethodDescription& method, const std::vector<Film>& truth,
                 StepProgress& progress) {
        const MethodFacts& facts = method.facts();
        const std::string what = "against the reference: " + facts.name;
        const std::vector<Film> films = films_of(method, false, progress);
        const PixelMask counted = reached_pixels(films.front(), truth.front());
        const CellLight known = cell_light(truth, counted);
        const BiasAllowed room = facts.is_unbiased ? BiasAllowed{} : allowed;
        const CellGap first = gap(cell_light(films, counted), known, room);
        if (first.holds || facts.more_effort.empty()) {
            add(what, verdict(first.holds), first.text);
            return;
        }
        progress.begin(facts.name + " with more effort");
        const std::vector<Film> better = films_of(method, true, progress);
        const CellGap second = gap(cell_light(better, counted), known, room);
        const bool shrinks = second.whole <= most_while_shrinking &&
                             1.3 * second.whole <= first.whole &&
                             second.cells_off <= first.cells_off;
        add(what, verdict(second.holds || shrinks),
            first.text + "; with more effort " + second.text);
    }

    SceneDesc desc_;
    Scene scene_;
    RunOptions options_;
    std::vector<const MethodDescription*> methods_;
    std::vector<const MethodDescription*> served_;
    std::map<std::string, double> seconds_of_picture_;  ///< with all threads
    SceneReport report_;
};

const char* word(Verdict verdict) {
    switch (verdict) {
        case Verdict::holds: return "holds";
        case Verdict::fails: return "FAILS";
        default: return "-";
    }
}

}  // namespace

bool SceneReport::holds() const {
    return std::ranges::none_of(findings,
                                [](const Finding& each) { return each.verdict == Verdict::fails; });
}

std::string SceneReport::text() const {
    std::string text;
    for (const Finding& each : findings)
        text += fmt::format("{:<5} {:<38} {}\n", word(each.verdict), each.what, each.detail);
    return text + (holds() ? "verify: all holds\n" : "verify: something does not hold\n");
}

SceneReport verify_scene(SceneFile file, const std::vector<std::string>& methods,
                         const RunOptions& options) {
    return SceneVerifier(std::move(file.desc), methods, options).run();
}

}  // namespace caustics::experiments
