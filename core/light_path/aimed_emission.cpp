#include "core/light_path/aimed_emission.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/math/sampling.h"

namespace caustics {
namespace {

Surroundings aimed_at(const Scene& scene, Aim where) {
    Surroundings all = scene.surroundings();
    all.everywhere = where == Aim::everywhere;
    return all;
}

// Of some lights, the first of which has that number, those that send any power there.
std::vector<AimedSource> aimed_sources(std::span<const Light> lights, std::uint32_t first,
                                       const Surroundings& scene) {
    std::vector<AimedSource> sources;
    if (scene.casters.empty() && !scene.everywhere) return sources;
    for (std::uint32_t i = 0; i < lights.size(); ++i)
        for (AimedSource& source : aim(lights[i], scene)) {
            if (is_black(source.power)) continue;
            source.light = first + i;
            sources.push_back(std::move(source));
        }
    return sources;
}

// A path has a share of all power: of 1e-8 of 1e-32 W a float still has five digits.
void require_power(const std::vector<AimedSource>& sources, const Spectrum& total,
                   bool everywhere) {
    constexpr float least = 1e-32F;
    constexpr float most = 1e34F;
    if (sources.empty() || (total.maxCoeff() >= least && (total <= most).all())) return;
    throw UnsupportedScene(
        fmt::format("the lights send {:.3g} W towards {}, beyond the {:g} to {:g} W that floats "
                    "serve (make lights stronger or weaker, or the scene larger or smaller)",
                    total.maxCoeff(), everywhere ? "the scene" : "the casters", least, most));
}

EmissionCone plain(const AimedCone& aim) {
    const auto& [s, t, n] = aim.frame;
    return {aim.cone.one_minus_cos,
            {s.x(), s.y(), s.z()},
            {t.x(), t.y(), t.z()},
            {n.x(), n.y(), n.z()}};
}

}  // namespace

AimedEmission::AimedEmission(const Scene& scene, Isa isa, Aim where)
    : AimedEmission(scene, isa, where, scene.lights(), 0) {}

AimedEmission::AimedEmission(const Scene& scene, Isa isa, Aim where, std::uint32_t light)
    : AimedEmission(scene, isa, where, std::span(scene.lights()).subspan(light, 1), light) {}

AimedEmission::AimedEmission(const Scene& scene, Isa isa, Aim where, std::span<const Light> lights,
                             std::uint32_t first_light)
    : scene_(scene),
      surroundings_(aimed_at(scene, where)),
      kernels_(emission_kernels(isa)),
      sources_(aimed_sources(lights, first_light, surroundings_)) {
    require_power(sources_, total_power(), where == Aim::everywhere);
    const auto total = static_cast<double>(total_power().mean());
    double sum = 0;
    for (const AimedSource& source : sources_) {
        const double share = static_cast<double>(source.power.mean()) / total;
        cumulative_.push_back(sum += share);
        flux_.push_back(source.power / static_cast<float>(share));
        first_cone_.push_back(static_cast<std::uint32_t>(cones_.size()));
        for (const AimedCone& aim : source.cones) cones_.push_back(plain(aim));
        cones_.resize(cones_.size() + source.discs.size());
        has_targets_ = has_targets_ || !source.targets.empty();
    }
}

Spectrum AimedEmission::total_power() const {
    Spectrum total = black();
    for (const AimedSource& source : sources_) total += source.power;
    return total;
}

double AimedEmission::least_carried() const {
    SpectrumSum squares = SpectrumSum::Zero();
    for (std::size_t i = 0; i < sources_.size(); ++i)
        squares += sources_[i].power.cast<double>() * flux_[i].cast<double>();
    const SpectrumSum total = total_power().cast<double>();
    double least = 1;
    for (Eigen::Index c = 0; c < 3; ++c)
        if (total[c] > 0) least = std::min(least, total[c] * total[c] / squares[c]);
    return least;
}

bool AimedEmission::has_extent() const {
    return std::ranges::any_of(sources_, [this](const AimedSource& source) {
        return caustics::has_extent(scene_.lights()[source.light]);
    });
}

// Picks a source and one of its regions; x becomes what is left of it.
std::uint32_t AimedEmission::choose(double& x, std::uint32_t& cone) const {
    const std::size_t source = pick_and_stretch(cumulative_, x);
    const std::size_t region = pick_and_stretch(sources_[source].cumulative, x);
    cone = first_cone_[source] + static_cast<std::uint32_t>(region);
    return static_cast<std::uint32_t>(source);
}

// Samples the start of a ray of a source with targets, and returns the cone from there to the target.
EmissionCone AimedEmission::cone_at_start(std::uint32_t source, std::uint32_t cone, Rng& rng,
                                          SegmentEnd& start) const {
    const AimedSource& from = sources_[source];
    start = start_of(scene_.lights()[from.light], surroundings_, from, rng);
    const AimedSphere& target = from.targets[cone - first_cone_[source]];
    const DirectionCone aim = cone_from(start.position, target.sphere);
    return plain({aim, Frame(aim.axis)});
}

std::optional<LightParticle> AimedEmission::emit(Rng& rng) const {
    if (sources_.empty()) return {};
    double x = rng.next_fine();
    const double y = rng.next_fine();
    std::uint32_t cone = 0;
    const std::uint32_t source = choose(x, cone);
    AimedSample sample;
    EmissionCone at = cones_[cone];
    if (!sources_[source].targets.empty()) {
        at = cone_at_start(source, cone, rng, sample.start);
        sample.width = at.one_minus_cos;
    }
    float* const w = sample.direction.data();
    const std::uint32_t first = 0;
    // Nothing to put side by side; all kernels give the same bits.
    emission_kernels(Isa::plain)
        .aim({1, &x, &y, &at, &first}, {{&sample.disc.x(), &sample.disc.y()}, {w, w + 1, w + 2}});
    return send(source, cone, sample, rng);
}

void AimedEmission::emit(const EmissionSamples& samples,
                         std::vector<LightPathStart>& starts) const {
    if (sources_.empty()) return;
    constexpr std::size_t most = EmissionSamples::most;
    std::array<double, most> x;
    std::array<std::uint32_t, most> source, cone, own;
    std::array<SegmentEnd, most> start;
    std::array<EmissionCone, most> at;
    alignas(64) std::array<std::array<float, most>, 5> to;
    std::ranges::copy(samples.x(), x.begin());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        source[i] = choose(x[i], cone[i]);
        if (!has_targets_) continue;
        own[i] = static_cast<std::uint32_t>(i);
        Rng rng = samples.rng(i);
        at[i] = sources_[source[i]].targets.empty()
                    ? cones_[cone[i]]
                    : cone_at_start(source[i], cone[i], rng, start[i]);
    }
    auto& [u, v, wx, wy, wz] = to;
    const EmissionCone* const cones = has_targets_ ? at.data() : cones_.data();
    const std::uint32_t* const numbers = has_targets_ ? own.data() : cone.data();
    kernels_.aim({samples.size(), x.data(), samples.y().data(), cones, numbers},
                 {{u.data(), v.data()}, {wx.data(), wy.data(), wz.data()}});
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const bool is_placed = !sources_[source[i]].targets.empty();
        Rng rng = samples.rng(i, is_placed ? 4 : 2);
        const AimedSample sample{0, Vec2(u[i], v[i]), Vec3(wx[i], wy[i], wz[i]),
                                 is_placed ? start[i] : SegmentEnd{},
                                 is_placed ? at[i].one_minus_cos : 0};
        const auto particle = send(source[i], cone[i], sample, rng);
        if (particle) starts.push_back({*particle, rng, samples.path(i)});
    }
}

std::optional<LightParticle> AimedEmission::send(std::uint32_t source, std::uint32_t cone,
                                                 AimedSample sample, Rng& rng) const {
    const AimedSource& from = sources_[source];
    sample.region = cone - first_cone_[source];
    const auto ray = caustics::send(scene_.lights()[from.light], surroundings_, from, sample, rng);
    if (!ray) return {};
    return LightParticle{*ray, flux_[source], scene_.light_media()[from.light].absorption};
}

}  // namespace caustics
