#pragma once

#include "core/lights/aimed_source.h"
#include "core/lights/light_words.h"
#include "core/math/value_hash.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics {

/// The front side of a shape of the scene; the shape's file entry holds it, and the exporters write it
/// there. Its members: light.h.
struct AreaLight {
    std::uint32_t shape = 0;
    Spectrum radiance = Spectrum::Ones();  ///< [W m^-2 sr^-1]
    AreaSampler sampler;

    static constexpr int family = 2;
    static ObjectText text();
    /// Its radiance.
    static Spectrum read(const JsonNode& node);

    std::string line(const Surroundings& scene, const Vec3d& origin) const;
    void add_to(ValueHash& hash) const;
    std::vector<AimedSource> aim(const Surroundings& scene) const;
    /// Samples the start of a ray of a source with targets.
    SegmentEnd start(const Surroundings& scene, const AimedSource& source, Rng& rng) const;
    std::optional<Ray> send(const Surroundings& scene, const AimedSource& source,
                            const AimedSample& sample, Rng& rng) const;
    std::optional<LightArrival> arrival(const Surroundings& scene, const Vec3& at, Rng& rng) const;
    /// Solid-angle density at a place of a point drawn uniformly by area [1/sr].
    float pdf_w(float distance2, float cos_light) const {
        return distance2 / (cos_light * static_cast<float>(sampler.area()));
    }

private:
    AimedSource cones_from(const Surroundings& scene, const BoundingSphere& from,
                           double area) const;
    std::optional<AimedSource> spheres_from_places(const Surroundings& scene) const;
    std::vector<AimedSource> pieces_of(const Surroundings& scene) const;
};

}  // namespace caustics
