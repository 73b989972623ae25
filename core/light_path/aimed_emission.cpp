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

// Picks a source and one of its regions; x becomes what is left of it.
std::uint32_t AimedEmission::choose(double& x, std::uint32_t& cone) const {
    const std::size_t source = pick_and_stretch(cumulative_, x);
    const std::size_t region = pick_and_stretch(sources_[source].cumulative, x);
    cone = first_cone_[source] + static_cast<std::uint32_t>(region);
    return static_cast<std::uint32_t>(source);
}

std::optional<LightParticle> AimedEmission::emit(Rng& rng) const {
    if (sources_.empty()) return {};
    double x = rng.next_fine();
    const double y = rng.next_fine();
    std::uint32_t cone = 0;
    const std::uint32_t source = choose(x, cone);
    AimedSample sample;
    float* const w = sample.direction.data();
    // Nothing to put side by side; all kernels give the same bits.
    emission_kernels(Isa::plain)
        .aim({1, &x, &y, cones_.data(), &cone},
             {{&sample.disc.x(), &sample.disc.y()}, {w, w + 1, w + 2}});
    return send(source, cone, sample, rng);
}

void AimedEmission::emit(const EmissionSamples& samples,
                         std::vector<LightPathStart>& starts) const {
    if (sources_.empty()) return;
    constexpr std::size_t most = EmissionSamples::most;
    std::array<double, most> x;
    std::array<std::uint32_t, most> source, cone;
    alignas(64) std::array<std::array<float, most>, 5> to;
    std::ranges::copy(samples.x(), x.begin());
    for (std::size_t i = 0; i < samples.size(); ++i) source[i] = choose(x[i], cone[i]);
    auto& [u, v, wx, wy, wz] = to;
    kernels_.aim({samples.size(), x.data(), samples.y().data(), cones_.data(), cone.data()},
                 {{u.data(), v.data()}, {wx.data(), wy.data(), wz.data()}});
    for (std::size_t i = 0; i < samples.size(); ++i) {
        Rng rng = samples.rng(i);
        const auto particle =
            send(source[i], cone[i], {0, Vec2(u[i], v[i]), Vec3(wx[i], wy[i], wz[i])}, rng);
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
