#include "core/aimed_emission.h"

#include <cmath>

#include "core/frame.h"
#include "core/sampling.h"

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

}  // namespace

AimedEmission::AimedEmission(const Scene& scene) : scene_(scene), sources_(aimed_sources(scene)) {
    const auto total = static_cast<double>(total_power().mean());
    double sum = 0;
    for (const AimedSource& source : sources_) {
        const double share = static_cast<double>(source.power.mean()) / total;
        cumulative_.push_back(sum += share);
        flux_.push_back(source.power / static_cast<float>(share));
    }
}

Spectrum AimedEmission::total_power() const {
    Spectrum total = black();
    for (const AimedSource& source : sources_) total += source.power;
    return total;
}

std::optional<LightParticle> AimedEmission::emit(Rng& rng) const {
    const double x = rng.next_fine();
    const double y = rng.next_fine();
    return emit({x, y}, rng);
}

std::optional<LightParticle> AimedEmission::emit(const Vec2d& point, Rng& rng) const {
    if (sources_.empty()) return {};
    double x = point.x();
    const std::size_t index = pick_and_stretch(cumulative_, x);
    const AimedSource& source = sources_[index];
    const std::size_t region = pick_and_stretch(source.cumulative, x);
    const Vec2 disc = concentric_disc(static_cast<float>(x), static_cast<float>(point.y()));
    if (source.cones.empty()) {
        const std::optional<Ray> ray = emit_directional(source, region, disc, rng);
        if (!ray) return {};
        return LightParticle{*ray, flux_[index]};
    }
    const AimedCone& aim = source.cones[region];
    const Vec3 direction = aim.frame.to_world(cap_from_disc(aim.cone.one_minus_cos, disc));
    if (!kept_in_union(source, aim, direction, rng)) return {};
    if (const auto* light = std::get_if<PointLight>(&scene_.lights()[source.light]))
        return LightParticle{Ray{light->position, direction}, flux_[index]};
    const std::optional<Ray> ray = emit_area(source, direction, rng);
    if (!ray) return {};
    return LightParticle{*ray, flux_[index]};
}

std::optional<Ray> AimedEmission::emit_area(const AimedSource& source, const Vec3& direction,
                                            Rng& rng) const {
    const auto& light = std::get<AreaLight>(scene_.lights()[source.light]);
    const float offset = scene_.offset(light.shape);
    if (source.facing_sphere) {
        SegmentEnd end = facing_point(*source.facing_sphere, direction, rng);
        end.offset = offset;
        return spawn_ray(end, direction);
    }
    const Vec2 size = source.high - source.low;
    const float u0 = source.low.x() + size.x() * rng.next();
    const float u1 = source.low.y() + size.y() * rng.next();
    const auto sample = light.sampler.sample(scene_.shapes()[light.shape], u0, u1);
    const float cosine = sample.normal.dot(direction);
    if (cosine <= rng.next() * source.max_cosine) return {};
    return spawn_ray({sample.position, sample.normal, offset}, direction);
}

std::optional<Ray> AimedEmission::emit_directional(const AimedSource& source, std::size_t region,
                                                   const Vec2& at, Rng& rng) const {
    const Vec3& along = std::get<DirectionalLight>(scene_.lights()[source.light]).direction;
    const AimedDisc& disc = source.discs[region];
    const Vec3 point =
        disc.centre + disc.radius * (source.across.s * at.x() + source.across.t * at.y());
    if (source.discs.size() > 1) {
        int holding = 0;
        for (const AimedDisc& other : source.discs) {
            const Vec3 offset = point - other.centre;
            const Vec3 across = offset - offset.dot(along) * along;
            holding += &other == &disc || across.norm() <= other.radius ? 1 : 0;
        }
        if (holding > 1 && rng.next() * static_cast<float>(holding) >= 1) return {};
    }
    // Start on the plane that touches the scene's bounding sphere from outside.
    const Vec3 centre = scene_.bounds().center();
    const float behind = (point - centre).dot(along) + 0.505F * scene_.diameter();
    return Ray{point - behind * along, along};
}

}  // namespace caustics
