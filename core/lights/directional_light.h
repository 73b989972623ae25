#pragma once

#include "core/lights/aimed_source.h"
#include "core/lights/light_words.h"
#include "core/math/value_hash.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics {

/// Parallel rays from far away. Its members: light.h.
struct DirectionalLight {
    Vec3 direction = Vec3::UnitZ();          ///< unit, the way the light travels
    Spectrum irradiance = Spectrum::Ones();  ///< on a plane across the direction [W/m^2]

    static constexpr int family = 1;
    static ObjectText text();
    static DirectionalLight read(const JsonNode& node, const Vec3d& origin);

    std::string line(const Surroundings& scene, const Vec3d& origin) const;
    void add_to(ValueHash& hash) const;
    void scale(const Spectrum& factor) { irradiance *= factor; }
    LightPoint point() const { return {.travel = direction, .strength = irradiance}; }
    std::vector<AimedSource> aim(const Surroundings& scene) const;
    std::optional<Ray> send(const Surroundings& scene, const AimedSource& source,
                            const AimedSample& sample, Rng& rng) const;
    std::optional<LightArrival> arrival(const Surroundings& scene, const Vec3& at, Rng& rng) const;
    MitsubaEmitter to_mitsuba() const;
    PovrayLight to_povray(const Surroundings& scene) const;
};

}  // namespace caustics
