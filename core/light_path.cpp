#include "core/light_path.h"

#include <algorithm>
#include <cmath>

#include "core/frame.h"
#include "core/optics.h"
#include "core/sampling.h"

namespace caustics {
namespace {

// The narrowest cone round the direction to the bounding sphere's centre that holds a caster as
// seen from a point: exact for spheres, by the hull's vertices for all others (a cone of less
// than a right angle is convex, so it holds what its vertices span).
DirectionCone cone_from_point(const Shape& caster, const Vec3& from) {
    const BoundingSphere sphere = bounding_sphere(caster);
    const Vec3 to_centre = sphere.centre - from;
    const float distance = to_centre.norm();
    if (distance == 0) return {};
    const Vec3 axis = to_centre / distance;
    if (caster.primitive == Primitive::sphere) {
        const float sine = sphere.radius / distance * (1 + 1e-5F);
        return sine < 1 ? DirectionCone::from_sine(axis, sine) : DirectionCone{};
    }
    float one_minus_cos = 0;
    for (const Vec3& p : hull_points(caster))
        one_minus_cos = std::max(one_minus_cos, ((p - from).normalized() - axis).squaredNorm() / 2);
    // Unit vectors are good to 1e-7: widened by that angle and a little more.
    const float widened = one_minus_cos * (1 + 1e-5F) + 4e-7F * std::sqrt(2 * one_minus_cos);
    return widened < 0.99F ? DirectionCone{axis, widened} : DirectionCone{};
}

// All directions from any point of one sphere to any point of another.
DirectionCone cone_between(const BoundingSphere& from, const BoundingSphere& to) {
    const Vec3 towards = to.centre - from.centre;
    const float distance = towards.norm();
    const float reach = (from.radius + to.radius) * (1 + 1e-5F);
    if (distance <= reach) return {};
    return DirectionCone::from_sine(towards / distance, reach / distance);
}

// Bound of n . w over a cone of directions.
float max_cosine_in_cone(const Vec3& n, const DirectionCone& cone) {
    const float to_axis = std::acos(std::clamp(n.dot(cone.axis), -1.0F, 1.0F));
    // acos of a float is good to 4e-4 rad near 0.
    return std::cos(std::max(0.0F, to_axis - cone.angle() - 1e-3F));
}

bool is_flat(const Shape& shape) {
    return shape.primitive == Primitive::rectangle || shape.primitive == Primitive::disk;
}

std::vector<double> normalised_sums(const std::vector<double>& measures) {
    std::vector<double> sums;
    double sum = 0;
    for (const double measure : measures) sums.push_back(sum += measure);
    for (double& share : sums) share /= sum;
    return sums;
}

}  // namespace

void LightPathCounts::add(const LightPathCounts& other) {
    emitted += other.emitted;
    aimed += other.aimed;
    missed += other.missed;
    escaped += other.escaped;
    absorbed += other.absorbed;
    depth_limited += other.depth_limited;
    stored += other.stored;
}

void LightPathCounts::add_to(Counters& counters) const {
    counters["photons_emitted"] += emitted;
    counters["photons_aimed"] += aimed;
    counters["photons_missed"] += missed;
    counters["photons_escaped"] += escaped;
    counters["photons_absorbed"] += absorbed;
    counters["photons_depth_limited"] += depth_limited;
    counters["photons_stored"] += stored;
}

AimedEmission::AimedEmission(const Scene& scene) : scene_(scene) {
    for (std::uint32_t i = 0; i < scene.lights().size(); ++i) {
        Source source;
        source.light = i;
        const Light& light = scene.lights()[i];
        double measure = 0;
        if (const auto* directional = std::get_if<DirectionalLight>(&light)) {
            measure = aim_discs(source);
            source.power = directional->irradiance * static_cast<float>(measure);
        } else if (const auto* point = std::get_if<PointLight>(&light)) {
            measure = aim_cones(source, {point->position, 0}, nullptr);
            source.power = point->intensity * static_cast<float>(measure);
        } else {
            const auto& area = std::get<AreaLight>(light);
            const Shape& shape = scene.shapes()[area.shape];
            measure = aim_cones(source, bounding_sphere(shape), &shape);
            source.power = area.radiance * static_cast<float>(area.sampler.area() * measure) *
                           source.max_cosine;
        }
        if (measure > 0 && !is_black(source.power)) sources_.push_back(std::move(source));
    }
    const double total = static_cast<double>(total_power().mean());
    double sum = 0;
    for (Source& source : sources_) {
        source.share = static_cast<double>(source.power.mean()) / total;
        cumulative_.push_back(sum += source.share);
    }
}

double AimedEmission::aim_cones(Source& source, const BoundingSphere& from, const Shape* emitter) {
    std::vector<double> measures;
    float max_cosine = emitter != nullptr && is_flat(*emitter) ? 0.0F : 1.0F;
    const Vec3 normal = emitter != nullptr ? std::get<AreaLight>(scene_.lights()[source.light])
                                                 .sampler.sample(*emitter, 0, 0)
                                                 .normal
                                           : Vec3::UnitZ();
    for (const std::uint32_t caster : scene_.casters()) {
        const Shape& shape = scene_.shapes()[caster];
        const DirectionCone cone = emitter == nullptr ? cone_from_point(shape, from.centre)
                                                      : cone_between(from, bounding_sphere(shape));
        max_cosine = std::max(max_cosine, max_cosine_in_cone(normal, cone));
        source.cones.push_back(cone);
        measures.push_back(cone.solid_angle());
        if (!cone.is_whole_sphere()) continue;
        // All directions hold every other cone: it alone is the union.
        source.cones = {cone};
        measures = {cone.solid_angle()};
        max_cosine = 1;
        break;
    }
    if (measures.empty() || max_cosine <= 0) return 0;
    source.max_cosine = max_cosine;
    source.cumulative = normalised_sums(measures);
    double total = 0;
    for (const double measure : measures) total += measure;
    return total;
}

double AimedEmission::aim_discs(Source& source) {
    std::vector<double> measures;
    double total = 0;
    for (const std::uint32_t caster : scene_.casters()) {
        const BoundingSphere sphere = bounding_sphere(scene_.shapes()[caster]);
        const float radius = sphere.radius * (1 + 1e-5F);
        source.discs.push_back({sphere.centre, radius});
        measures.push_back(pi_d * static_cast<double>(radius) * static_cast<double>(radius));
        total += measures.back();
    }
    if (total > 0) source.cumulative = normalised_sums(measures);
    return total;
}

Spectrum AimedEmission::total_power() const {
    Spectrum total = black();
    for (const Source& source : sources_) total += source.power;
    return total;
}

std::optional<LightParticle> AimedEmission::emit(Rng& rng) const {
    if (sources_.empty()) return {};
    const Source& source = sources_[sources_.size() == 1 ? 0 : pick(cumulative_, rng.next())];
    const Light& light = scene_.lights()[source.light];
    std::optional<Ray> ray;
    if (std::holds_alternative<DirectionalLight>(light))
        ray = emit_directional(source, std::get<DirectionalLight>(light), rng);
    else if (std::holds_alternative<PointLight>(light))
        ray = emit_point(source, std::get<PointLight>(light), rng);
    else
        ray = emit_area(source, std::get<AreaLight>(light), rng);
    if (!ray) return {};
    return LightParticle{*ray, source.power / static_cast<float>(source.share)};
}

std::optional<Vec3> AimedEmission::direction_in_union(const Source& source, Rng& rng) {
    const float u = rng.next();
    const DirectionCone& cone =
        source.cones[source.cones.size() == 1 ? 0 : pick(source.cumulative, u)];
    const float u0 = rng.next();
    const float u1 = rng.next();
    const Vec3 direction = cone.sample(u0, u1);
    if (source.cones.size() == 1) return direction;
    // Thinning by the number of cones that hold the direction makes the union uniform.
    int holding = 0;
    for (const DirectionCone& other : source.cones)
        holding += &other == &cone || other.contains(direction) ? 1 : 0;
    if (rng.next() * static_cast<float>(holding) >= 1) return {};
    return direction;
}

std::optional<Ray> AimedEmission::emit_point(const Source& source, const PointLight& light,
                                             Rng& rng) {
    const std::optional<Vec3> direction = direction_in_union(source, rng);
    if (!direction) return {};
    return spawn_ray({light.position}, *direction);
}

std::optional<Ray> AimedEmission::emit_area(const Source& source, const AreaLight& light,
                                            Rng& rng) const {
    const std::optional<Vec3> direction = direction_in_union(source, rng);
    if (!direction) return {};
    const float u0 = rng.next();
    const float u1 = rng.next();
    const auto sample = light.sampler.sample(scene_.shapes()[light.shape], u0, u1);
    const float cosine = sample.normal.dot(*direction);
    if (cosine <= rng.next() * source.max_cosine) return {};
    return spawn_ray({sample.position, sample.normal, scene_.offset(light.shape)}, *direction);
}

std::optional<Ray> AimedEmission::emit_directional(const Source& source,
                                                   const DirectionalLight& light, Rng& rng) const {
    const float u = rng.next();
    const Disc& disc = source.discs[source.discs.size() == 1 ? 0 : pick(source.cumulative, u)];
    const float u0 = rng.next();
    const float u1 = rng.next();
    const Vec2 local = disc.radius * uniform_disc(u0, u1);
    const Frame frame(light.direction);
    const Vec3 point = disc.centre + frame.s * local.x() + frame.t * local.y();
    if (source.discs.size() > 1) {
        int holding = 0;
        for (const Disc& other : source.discs) {
            const Vec3 offset = point - other.centre;
            const Vec3 across = offset - offset.dot(light.direction) * light.direction;
            holding += &other == &disc || across.norm() <= other.radius ? 1 : 0;
        }
        if (rng.next() * static_cast<float>(holding) >= 1) return {};
    }
    // Start on the plane that touches the scene's bounding sphere from outside.
    const Vec3 centre = scene_.bounds().center();
    const float behind = (point - centre).dot(light.direction) + 0.505F * scene_.diameter();
    return spawn_ray({point - behind * light.direction}, light.direction);
}

namespace {

// One decision for reflection, refraction or absorption; the survivor's channels are rescaled so
// that the mean over many particles is the split's weights [C11, after Jensen 2004].
std::optional<Vec3> roulette(const SpecularSplit& split, Rng& rng, Spectrum& flux) {
    const float before = flux.mean();
    const float reflect_share = (split.reflected_weight * flux).mean() / before;
    const float refract_share = (split.refracted_weight * flux).mean() / before;
    const float u = rng.next();
    if (u < reflect_share) {
        flux *= split.reflected_weight / reflect_share;
        return split.reflected;
    }
    if (u < reflect_share + refract_share) {
        flux *= split.refracted_weight / refract_share;
        return split.refracted;
    }
    return {};
}

std::optional<Deposit> deposit_at(const Scene& scene, const SurfacePoint& hit, const Vec3& wi,
                                  const Spectrum& flux, int bounces) {
    const bool front = hit.geometric_normal.dot(wi) > 0;
    if (!scatters_from(scene.shape_at(hit).bsdf, front)) return {};
    Deposit deposit;
    deposit.position = hit.position;
    deposit.geometric_normal = front ? hit.geometric_normal : Vec3(-hit.geometric_normal);
    deposit.shading_normal = front ? hit.shading_normal : Vec3(-hit.shading_normal);
    deposit.wi = wi;
    deposit.uv = hit.uv;
    deposit.offset = hit.offset;
    deposit.flux = flux;
    deposit.shape = hit.shape;
    deposit.bounces = bounces;
    return deposit;
}

}  // namespace

std::optional<Deposit> trace_light_path(const Scene& scene, const LightParticle& particle,
                                        int max_bounces, Rng& rng, LightPathCounts& counts) {
    Ray ray = particle.ray;
    Spectrum flux = particle.flux;
    std::optional<Spectrum> start_absorption;
    for (int bounces = 0;; ++bounces) {
        const std::optional<SurfacePoint> hit = scene.intersect(ray);
        if (!hit) {
            ++(bounces == 0 ? counts.missed : counts.escaped);
            return {};
        }
        const Bsdf& bsdf = scene.shape_at(*hit).bsdf;
        const Vec3 w = -ray.direction;
        if (bounces == 0 && is_receiver(bsdf)) {
            ++counts.missed;
            return {};
        }
        flux *= segment_transmittance(
            start_absorption, medium_absorption(bsdf, hit->geometric_normal, w), hit->distance);
        if (is_receiver(bsdf)) {
            std::optional<Deposit> deposit = deposit_at(scene, *hit, w, flux, bounces);
            ++(deposit ? counts.stored : counts.absorbed);
            return deposit;
        }
        if (bounces == max_bounces) {
            ++counts.depth_limited;
            return {};
        }
        const SpecularSplit split =
            split_specular(bsdf, hit->geometric_normal, hit->shading_normal, w);
        const std::optional<Vec3> next =
            flux.mean() > 0 ? roulette(split, rng, flux) : std::nullopt;
        if (!next) {
            ++counts.absorbed;
            return {};
        }
        start_absorption = medium_absorption(bsdf, hit->geometric_normal, *next);
        ray = spawn_ray({hit->position, hit->geometric_normal, hit->offset}, *next);
    }
}

}  // namespace caustics
