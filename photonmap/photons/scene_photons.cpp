#include "photonmap/photons/scene_photons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/light_path/aimed_emission.h"
#include "core/light_path/empty_caustic.h"
#include "core/light_path/even_paths.h"
#include "photonmap/photons/photon_yield.h"

namespace caustics::photonmap {

namespace {

/// A tree's indices have 32 bits, its node numbers' children one more.
constexpr std::uint64_t most_photons = 2'000'000'000;

constexpr std::size_t pilot_parts = 16;
/// The pilot goes on until it has stored this many photons.
constexpr std::uint64_t pilot_photons = 256;
/// How many standard errors the planned number of paths leaves room for.
constexpr double safety = 4.5;

constexpr const char* accept_few = "give `emitted` instead of `photons` to accept few or none";

/// Paths of a scene: emission, specular chain, photons.
class ScenePaths final : public PathTracer {
public:
    struct Settings {
        LightPathSettings path;
        /// The first paths are such a batch, or, where `repeated`, all are, batch after batch. Other paths are random.
        std::optional<EvenPaths> even;
        bool repeated = false;
        std::uint64_t seed = 1;
        Stage stage = Stage::photons;
    };

    ScenePaths(const Scene& scene, const AimedEmission& emission, const Settings& settings)
        : scene_(scene), emission_(emission), settings_(settings) {}

    void trace(std::uint64_t first, std::uint64_t last, PhotonChunk& chunk) const override {
        chunk.counts.emitted += last - first;
        if (settings_.even)
            trace_together(first, last, chunk);
        else
            for (; first < last; ++first) trace_alone(first, chunk);
    }

private:
    /// Paths that are emitted together.
    struct Batch {
        EmissionSamples samples;
        std::vector<LightPathStart> starts;
        std::vector<DepositOfMany> deposits;
    };

    // Neighbours in a square start side by side.
    void trace_together(std::uint64_t first, std::uint64_t last, PhotonChunk& chunk) const {
        Batch batch;
        while (first < last) {
            draw(first, last, batch.samples);
            const std::size_t count = batch.samples.size();
            batch.starts.clear();
            emission_.emit(batch.samples, batch.starts);
            chunk.counts.aimed += batch.starts.size();
            follow(batch, chunk);
            first += count;
        }
    }

    // What random paths hit is nowhere near: their rays wait for memory, and emission is done meanwhile.
    void trace_alone(std::uint64_t path, PhotonChunk& chunk) const {
        Rng rng(settings_.seed, settings_.stage, path);
        const auto particle = emission_.emit(rng);
        if (!particle) return;
        ++chunk.counts.aimed;
        follow_alone(*particle, path, rng, chunk);
    }

    // Draws consecutive paths from `first`: at most EmissionSamples::most, all of one batch.
    void draw(std::uint64_t first, std::uint64_t last, EmissionSamples& samples) const {
        const std::uint64_t size = settings_.even->size();
        const std::uint64_t first_of_batch = settings_.repeated ? first - first % size : 0;
        const bool is_even = first - first_of_batch < size;
        if (is_even) last = std::min(last, first_of_batch + size);
        const ConsecutivePaths paths{settings_.seed, static_cast<std::uint32_t>(settings_.stage),
                                     first,
                                     std::min<std::uint64_t>(last - first, EmissionSamples::most)};
        if (is_even)
            settings_.even->draw(paths, first_of_batch, emission_.kernels(), samples);
        else
            samples.draw(paths, emission_.kernels());
    }

    void follow(Batch& batch, PhotonChunk& chunk) const {
        if (splits()) {
            for (LightPathStart& start : batch.starts)
                follow_alone(start.particle, start.path, start.rng, chunk);
            return;
        }
        batch.deposits.clear();
        trace_light_paths(scene_, batch.starts, settings_.path, chunk.counts, batch.deposits);
        for (const DepositOfMany& one : batch.deposits)
            chunk.add(batch.starts[one.start].path, one.deposit);
    }

    void follow_alone(const LightParticle& particle, std::uint64_t path, Rng& rng,
                      PhotonChunk& chunk) const {
        chunk.deposits.clear();
        (splits() ? trace_split_path : trace_light_path)(scene_, particle, settings_.path, rng,
                                                         chunk.counts, chunk.deposits);
        for (const Deposit& deposit : chunk.deposits) chunk.add(path, deposit);
    }

    bool splits() const { return settings_.path.interaction == Interaction::split; }

    const Scene& scene_;
    const AimedEmission& emission_;
    Settings settings_;
};

/// Paths to trace: their number, and how they are emitted.
struct Plan {
    std::uint64_t emitted = 0;
    std::optional<EvenPaths> even;  ///< the first of them
};

/// What the pilot's parts, alike and independent, stored.
struct Pilot {
    std::uint64_t part_paths = 0;
    std::array<LightPathCounts, pilot_parts> parts;

    LightPathCounts total() const {
        LightPathCounts sum;
        for (const LightPathCounts& part : parts) sum.add(part);
        return sum;
    }
    /// The number of paths that very likely store `wanted` photons: the pilot's own error and the
    /// scatter of the photons to come are allowed for.
    double paths_for(double wanted) const;
};

double Pilot::paths_for(double wanted) const {
    const double mean = static_cast<double>(total().stored) / pilot_parts;
    double variance = 0;  // of a part
    for (const LightPathCounts& part : parts)
        variance += std::pow(static_cast<double>(part.stored) - mean, 2) / (pilot_parts - 1);
    const auto part = static_cast<double>(part_paths);
    double paths = wanted * part / mean;
    for (int i = 0; i < 4; ++i) {
        const double by_pilot = variance / pilot_parts * std::pow(paths / part, 2);
        const double by_chance = variance * paths / part;
        paths = (wanted + safety * std::sqrt(by_pilot + by_chance)) * part / mean;
    }
    return paths;
}

/// Plans, traces and trims the photons of one scene.
class ScenePhotons {
public:
    ScenePhotons(const Scene& scene, const PhotonMapParams& params, const RunOptions& options,
                 AskYield ask, std::vector<Ray>* traced)
        : scene_(scene),
          params_(params),
          options_(options),
          ask_(ask),
          emission_(scene, options.isa),
          traced_(traced) {}

    TracedPhotons trace() const {
        if (emission_.empty()) return none();
        if (params_.emitted > 0) {
            Plan plan{params_.emitted, {}};
            if (stratified()) plan.even = EvenPaths::at_most(emission_, plan.emitted);
            return trace_planned(plan);
        }
        if (ask_ == AskYield::yes) ask_yield();
        if (stratified() || most_per_path() > 1) return trace_exactly();
        const PhotonTarget target{
            .stored = params_.photons, .capacity = params_.photons, .certain = params_.photons};
        return trace_photons(ScenePaths(scene_, emission_, settings({})), emission_.total_power(),
                             target, options_);
    }

private:
    bool stratified() const { return params_.emission == PhotonMapParams::Emission::stratified; }
    bool splits() const { return params_.interaction == Interaction::split; }

    // Photons that a path stores; one that splits stores few, as each takes its share of the weight.
    std::uint64_t most_per_path() const {
        if (splits()) return static_cast<std::uint64_t>(1 / lightest_branch);
        const auto is_both = [](const Shape& shape) { return shape.bsdf.mirror.has_value(); };
        if (std::ranges::none_of(scene_.shapes(), is_both)) return 1;
        return static_cast<std::uint64_t>(std::clamp(params_.max_bounces, 1, 64));
    }

    ScenePaths::Settings settings(const std::optional<EvenPaths>& even) const {
        std::optional<double> wavelength_shift;
        if (even && disperses(scene_))
            wavelength_shift = Rng(options_.seed, Stage::wavelength, 0).next_fine();
        return {.path = {params_.max_bounces, params_.interaction, traced_, wavelength_shift},
                .even = even,
                .seed = options_.seed};
    }

    TracedPhotons none() const {
        if (params_.photons > 0)
            throw UnsupportedScene("photonmap: no photon can be stored: " +
                                   why_nothing_is_aimed(scene_).value() + " (" + accept_few + ")");
        LightPathCounts counts;
        counts.emitted = params_.emitted;
        return {PhotonStore(0), counts, Spectrum::Ones()};
    }

    TracedPhotons trace_planned(const Plan& plan) const {
        const std::uint64_t per_path = most_per_path();
        const PhotonTarget target{
            .emitted = plan.emitted,
            .capacity = per_path * std::min(plan.emitted, most_photons / per_path),
            .certain = params_.photons};
        return trace_photons(ScenePaths(scene_, emission_, settings(plan.even)),
                             emission_.total_power(), target, options_);
    }

    TracedPhotons trace_exactly() const {
        double paths = run_pilot().paths_for(static_cast<double>(params_.photons));
        for (;; paths *= 1.1) {
            TracedPhotons photons = trace_planned(plan_of(paths));
            if (photons.store.size() < params_.photons) continue;
            drop_photons(photons, params_.photons, options_.seed);
            return photons;
        }
    }

    Plan plan_of(double paths) const {
        const auto least = static_cast<std::uint64_t>(std::ceil(paths));
        if (!stratified()) return {least, {}};
        const EvenPaths even = EvenPaths::at_least(emission_, least);
        return {even.size(), even};
    }

    ScenePaths yield_paths() const {
        ScenePaths::Settings alone = settings({});
        alone.path.traced = nullptr;
        alone.seed = seed_of_yield;
        alone.stage = Stage::photon_pilot;
        return {scene_, emission_, alone};
    }

    void ask_yield() const {
        require_yield(yield_paths(), {.count = params_.photons,
                                      .path_flux = emission_.total_power(),
                                      .method = "photonmap",
                                      .otherwise = accept_few,
                                      .when_hardly_any = accept_few});
    }

    Pilot run_pilot() const {
        const std::uint64_t part =
            std::clamp<std::uint64_t>(params_.photons / (32 * pilot_parts), 64, 16'384);
        for (Plan plan = plan_of(static_cast<double>(part));;
             plan = plan_of(4 * static_cast<double>(plan.emitted))) {
            const Pilot pilot = run_pilot(plan);
            if (pilot.total().stored >= pilot_photons) return pilot;
        }
    }

    Pilot run_pilot(const Plan& plan) const {
        ScenePaths::Settings pilot_settings = settings(plan.even);
        pilot_settings.path.traced = nullptr;
        pilot_settings.repeated = true;
        pilot_settings.stage = Stage::photon_pilot;
        const ScenePaths tracer(scene_, emission_, pilot_settings);
        Pilot pilot{plan.emitted, {}};
        parallel_for(options_.threads, pilot_parts, [&](std::size_t part, std::size_t) {
            PhotonChunk chunk(Spectrum::Ones() / emission_.total_power().maxCoeff(), options_.seed);
            tracer.trace(part * plan.emitted, (part + 1) * plan.emitted, chunk);
            pilot.parts[part] = chunk.counts;
        });
        return pilot;
    }

    const Scene& scene_;
    const PhotonMapParams& params_;
    const RunOptions& options_;
    AskYield ask_;
    AimedEmission emission_;
    std::vector<Ray>* traced_;
};

}  // namespace

TracedPhotons trace_scene(const Scene& scene, const PhotonMapParams& params,
                          const RunOptions& options, AskYield ask, std::vector<Ray>* traced) {
    return ScenePhotons(scene, params, options, ask, traced).trace();
}

}  // namespace caustics::photonmap
