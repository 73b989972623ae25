#include "core/light_path/aimed_emission.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/surface_offset.h"
#include "core/math/frame.h"
#include "core/math/sampling.h"

namespace caustics {
namespace {

// Thinning by the number of cones that hold the direction makes their union uniform.
bool kept_in_union(const AimedSource& source, const AimedCone& own, const Vec3& direction,
                   Rng& rng) {
    if (source.cones.size() == 1) return true;
    int holding = 0;
    for (const AimedCone& other : source.cones)
        holding += &other == &own || other.cone.contains(direction) ? 1 : 0;
    return holding == 1 || rng.next() * static_cast<float>(holding) < 1;
}

// A point of a sphere, uniform across `direction`, on the side that shines along it.
SegmentEnd facing_point(const BoundingSphere& sphere, const Vec3& direction, Rng& rng) {
    const float u0 = rng.next();
    const float u1 = rng.next();
    const Vec2 disc = concentric_disc(u0, u1);
    const float height = std::sqrt(std::max(0.0F, 1 - disc.squaredNorm()));
    const Vec3 normal = Frame(direction).to_world({disc.x(), disc.y(), height});
    return {sphere.centre + sphere.radius * normal, normal};
}

EmissionCone plain(const AimedCone& aim) {
    const auto& [s, t, n] = aim.frame;
    return {aim.cone.one_minus_cos,
            {s.x(), s.y(), s.z()},
            {t.x(), t.y(), t.z()},
            {n.x(), n.y(), n.z()}};
}

}  // namespace

AimedEmission::AimedEmission(const Scene& scene, Isa isa)
    : scene_(scene), kernels_(emission_kernels(isa)), sources_(aimed_sources(scene)) {
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
    Aim aim;
    aim.source = choose(x, aim.cone);
    float* const w = aim.direction.data();
    // Nothing to put side by side; all kernels give the same bits.
    emission_kernels(Isa::plain)
        .aim({1, &x, &y, cones_.data(), &aim.cone},
             {{&aim.disc.x(), &aim.disc.y()}, {w, w + 1, w + 2}});
    return send(aim, rng);
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
            send({source[i], cone[i], Vec2(u[i], v[i]), Vec3(wx[i], wy[i], wz[i])}, rng);
        if (particle) starts.push_back({*particle, rng, samples.path(i)});
    }
}

std::optional<LightParticle> AimedEmission::send(const Aim& aim, Rng& rng) const {
    const AimedSource& source = sources_[aim.source];
    const std::uint32_t region = aim.cone - first_cone_[aim.source];
    std::optional<Ray> ray;
    if (source.cones.empty()) {
        ray = send_through(source, source.discs[region], across(source, rng), aim.disc, rng);
    } else if (kept_in_union(source, source.cones[region], aim.direction, rng)) {
        if (const auto* light = std::get_if<PointLight>(&scene_.lights()[source.light]))
            ray = send_from_point(*light, aim.direction, rng);
        else
            ray = send_from_area(source, aim.direction, rng);
    }
    if (!ray) return {};
    return LightParticle{*ray, flux_[aim.source]};
}

// A spot light's particles are thinned by its falloff.
std::optional<Ray> AimedEmission::send_from_point(const PointLight& light, const Vec3& direction,
                                                  Rng& rng) {
    if (light.spot && !(rng.next() < light.spot->falloff(direction))) return {};
    return Ray{light.position, direction};
}

std::optional<Ray> AimedEmission::send_from_area(const AimedSource& source, const Vec3& direction,
                                                 Rng& rng) const {
    const auto& light = std::get<AreaLight>(scene_.lights()[source.light]);
    if (source.facing_sphere) {
        SegmentEnd end = facing_point(*source.facing_sphere, direction, rng);
        end.offset = rounding_offset(end.position);
        return spawn_ray(end, direction);
    }
    const Vec2 size = source.high - source.low;
    const float u0 = source.low.x() + size.x() * rng.next();
    const float u1 = source.low.y() + size.y() * rng.next();
    const auto sample = light.sampler.sample(scene_.shapes()[light.shape], u0, u1);
    const float cosine = sample.normal.dot(direction);
    if (cosine <= rng.next() * source.max_cosine) return {};
    return spawn_ray({sample.position, sample.normal, sample.offset}, direction);
}

// Round the direction of a light from far away: any, of a constant one.
Frame AimedEmission::across(const AimedSource& source, Rng& rng) const {
    if (!std::holds_alternative<ConstantLight>(scene_.lights()[source.light])) return source.across;
    const float u0 = rng.next();
    const float u1 = rng.next();
    return Frame(uniform_cap(2, u0, u1));
}

std::optional<Ray> AimedEmission::send_through(const AimedSource& source, const AimedDisc& disc,
                                               const Frame& across, const Vec2& at,
                                               Rng& rng) const {
    const Vec3& along = across.n;
    const Vec3 point = disc.centre + disc.radius * (across.s * at.x() + across.t * at.y());
    if (source.discs.size() > 1) {
        int holding = 0;
        for (const AimedDisc& other : source.discs) {
            const Vec3 offset = point - other.centre;
            const float aside = Vec3(offset - offset.dot(along) * along).norm();
            holding += &other == &disc || aside <= other.radius ? 1 : 0;
        }
        if (holding > 1 && rng.next() * static_cast<float>(holding) >= 1) return {};
    }
    return Ray{point + distance_to_entry(scene_.bounds(), point, along) * along, along};
}

}  // namespace caustics
