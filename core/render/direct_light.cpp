#include "core/render/direct_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/material/optics.h"
#include "core/material/wavelength.h"

namespace caustics {
namespace {

// f_r times the cosine of a direction on the lit side; 0 below the geometric surface.
Spectrum scattering(const ReceiverPoint& p, const Vec3& wi, Cosine cosine) {
    if (p.geometric_normal.dot(wi) <= 0) return black();
    const Vec3& normal = cosine == Cosine::shading ? p.shading_normal : p.geometric_normal;
    return evaluate(*p.bsdf, p.uv, p.shading_normal, p.wo, wi) * normal.dot(wi);
}

constexpr int most_crossings = 256;

/// The straight way along a ray, through dielectrics.
struct StraightWay {
    std::optional<SurfacePoint> end;   ///< on the first other surface
    float distance = 0;                ///< to there [m]
    bool crosses = false;              ///< a dielectric: that has said what lies on both its sides
    Spectrum left = Spectrum::Ones();  ///< of light along it
};

// At the angle of the thinner side, whose light always passes; `nm`: wavelength, 0 for the d line.
float passed(const Dielectric& glass, float cosine, float nm) {
    const float ratio = glass.relative_ior(true, nm);
    return 1 - fresnel_dielectric(std::abs(cosine), std::max(ratio, 1 / ratio));
}

/// What surfaces of dielectrics let pass, one after the other. Those that are dispersive let more of one wavelength
/// pass than of another, so that only the end of the way tells what is left of the channels. Between bins the share
/// is smooth.
class PassedSurfaces {
public:
    PassedSurfaces() { of_bin_.fill(1); }

    void add(const Dielectric& glass, float cosine) {
        shares_ *= glass.specular_transmittance;
        if (!glass.is_dispersive()) {
            shares_ *= passed(glass, cosine, 0);
            return;
        }
        for (std::size_t i = 0; i < of_bin_.size(); ++i)
            of_bin_[i] *= passed(glass, cosine, bins()[i].nm);
        disperses_ = true;
    }
    Spectrum shares() const {
        if (!disperses_) return shares_;
        Spectrum mean = black();
        for (std::size_t i = 0; i < of_bin_.size(); ++i) mean += bins()[i].weight * of_bin_[i];
        return shares_ * mean;
    }

private:
    static constexpr std::size_t bin_count = 16;
    static const std::vector<WavelengthBin>& bins() {
        static const std::vector<WavelengthBin> all = wavelength_bins(bin_count);
        return all;
    }

    Spectrum shares_ = Spectrum::Ones();
    std::array<float, bin_count> of_bin_;
    bool disperses_ = false;
};

StraightWay straight_way(const Scene& scene, Ray ray) {
    StraightWay way;
    PassedSurfaces passed_surfaces;
    const Spectrum* medium = nullptr;
    for (int crossing = 0; crossing < most_crossings; ++crossing) {
        const std::optional<SurfacePoint> hit = scene.intersect(ray);
        if (!hit) {
            way.left *= passed_surfaces.shares() * scene.transmittance_along(ray, medium);
            return way;
        }
        const Bsdf& bsdf = scene.shape_at(*hit).bsdf;
        way.distance += hit->distance;
        way.left *= segment_transmittance(
            medium, medium_absorption(bsdf, hit->geometric_normal, -ray.direction), hit->distance);
        const auto* const glass = std::get_if<Dielectric>(&bsdf.model);
        if (glass == nullptr) {
            way.end = hit;
            way.left *= passed_surfaces.shares();
            return way;
        }
        way.crosses = true;
        passed_surfaces.add(*glass, hit->shading_normal.dot(ray.direction));
        medium = medium_absorption(bsdf, hit->geometric_normal, ray.direction);
        const float left = ray.max_distance - hit->distance;
        ray = spawn_ray({hit->position, hit->geometric_normal, hit->offset}, ray.direction);
        ray.max_distance = left;
    }
    way.left = black();
    return way;
}

/// What reaches a receiver point straight from lights.
class DirectLight {
public:
    DirectLight(const Scene& scene, const ReceiverPoint& point, Shadows shadows, Cosine cosine,
                ShadowRays& rays)
        : scene_(scene),
          p_(point),
          opaque_(shadows == Shadows::opaque),
          cosine_(cosine),
          rays_(rays) {}

    Spectrum from_all(Rng& rng) const {
        Spectrum sum = by_light_samples(rng);
        if (std::ranges::any_of(scene_.lights(), has_extent)) sum += by_bsdf_sample(rng);
        return sum;
    }
    Spectrum by_light_samples(Rng& rng) const {
        Spectrum sum = black();
        for (std::size_t i = 0; i < scene_.lights().size(); ++i) sum += from(i, rng);
        return sum;
    }

private:
    // Where directions chosen at random may meet the light too, both ways share its work.
    Spectrum from(std::size_t light, Rng& rng) const {
        const auto arrival =
            arrival_from(scene_.lights()[light], scene_.surroundings(), p_.position, rng);
        if (!arrival) return black();
        const Spectrum f = scattering(p_, arrival->wi, cosine_);
        if (is_black(f) || is_black(arrival->strength)) return black();
        const Spectrum seen = seen_from(light, *arrival);
        const float other_way = arrival->is_delta ? 0 : pdf(arrival->wi);
        return f * seen * arrival->strength / (arrival->divisor + other_way);
    }

    Spectrum by_bsdf_sample(Rng& rng) const {
        const float u0 = rng.next();
        const float u1 = rng.next();
        const float u2 = rng.next();
        const auto wi = sample_direction(*p_.bsdf, p_.shading_normal, p_.wo, u0, u1, u2);
        if (!wi) return black();
        const Spectrum f = scattering(p_, *wi, cosine_);
        if (is_black(f)) return black();
        const StraightWay way = way_along(*wi);
        const MetLight met = met_light(scene_, way.end, *wi, way.distance);
        if (is_black(met.radiance)) return black();
        const Spectrum absorbed =
            way.end && !way.crosses
                ? segment_transmittance(scene_.area_light_medium(way.end->shape), nullptr,
                                        way.distance)
                : Spectrum(Spectrum::Ones());
        return f * way.left * absorbed * met.radiance / (met.pdf + pdf(*wi));
    }

    SegmentEnd start() const { return {p_.position, p_.geometric_normal, p_.offset}; }
    float pdf(const Vec3& wi) const {
        return direction_pdf(*p_.bsdf, p_.shading_normal, p_.wo, wi);
    }

    Spectrum seen_from(std::size_t light, const LightArrival& arrival) const {
        using Seen = KnownShadows::Seen;
        const Seen known =
            rays_.known != nullptr ? rays_.known->sees(p_, light, *rays_.context) : Seen::unknown;
        ++(known == Seen::unknown ? rays_.traced : rays_.spared);
        if (known == Seen::no) return black();
        const float distance = arrival.end ? (arrival.end->position - p_.position).norm() : 0;
        const Spectrum clear =
            segment_transmittance(scene_.light_media()[light].absorption, nullptr, distance);
        if (known == Seen::yes) return clear;
        return arrival.end ? seen_of(*arrival.end, clear) : seen_along(arrival.wi);
    }

    // Shares of light that come here; `clear` of the lamp's medium, where the way crosses no dielectric.
    Spectrum seen_of(const SegmentEnd& end, const Spectrum& clear) const {
        if (opaque_) return scene_.occluded(start(), end) ? black() : clear;
        const Ray ray = segment_between(start(), end);
        if (!(ray.max_distance > 0)) return clear;
        const StraightWay way = straight_way(scene_, ray);
        return way.crosses ? left(way) : Spectrum(left(way) * clear);
    }
    Spectrum seen_along(const Vec3& wi) const {
        if (opaque_)
            return scene_.occluded_along(start(), wi) ? black() : Spectrum(Spectrum::Ones());
        return left(straight_way(scene_, spawn_ray(start(), wi)));
    }
    static Spectrum left(const StraightWay& way) { return way.end ? black() : way.left; }

    StraightWay way_along(const Vec3& wi) const {
        const Ray ray = spawn_ray(start(), wi);
        if (!opaque_) return straight_way(scene_, ray);
        StraightWay way;
        way.end = scene_.intersect(ray);
        if (way.end) way.distance = way.end->distance;
        return way;
    }

    const Scene& scene_;
    const ReceiverPoint& p_;
    bool opaque_;
    Cosine cosine_;
    ShadowRays& rays_;
};

}  // namespace

MetLight met_light(const Scene& scene, const std::optional<SurfacePoint>& hit,
                   const Vec3& direction, float distance) {
    // Light from all around is found in this way alone.
    if (!hit) return {scene.background(), 0};
    const AreaLight* const light = scene.area_light(hit->shape);
    const float cos_light = -hit->geometric_normal.dot(direction);
    if (light == nullptr || cos_light <= 0) return {};
    return {light->radiance, light->pdf_w(distance * distance, cos_light)};
}

Spectrum direct_radiance(const Scene& scene, const ReceiverPoint& point, Rng& rng,
                         Shadows shadows) {
    ShadowRays rays;
    return DirectLight(scene, point, shadows, Cosine::shading, rays).from_all(rng);
}

Spectrum sampled_light(const Scene& scene, const ReceiverPoint& point, Rng& rng, Cosine cosine) {
    ShadowRays rays;
    return DirectLight(scene, point, Shadows::opaque, cosine, rays).by_light_samples(rng);
}

Spectrum direct_radiance(const Scene& scene, const ReceiverPoint& point, Rng& rng,
                         ShadowRays& rays) {
    return DirectLight(scene, point, Shadows::opaque, Cosine::shading, rays).from_all(rng);
}

}  // namespace caustics
