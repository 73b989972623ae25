#pragma once

#include "core/lights/aimed_source.h"
#include "core/lights/light_words.h"
#include "core/math/value_hash.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics {

/// Shines alike all round. Its members: light.h.
struct PointLight {
    Vec3 position = Vec3::Zero();
    Spectrum intensity = Spectrum::Ones();  ///< [W/sr]

    static constexpr int family = 0;
    static ObjectText text();
    static PointLight read(const JsonNode& node, const Vec3d& origin);

    std::string line(const Surroundings& scene, const Vec3d& origin) const;
    void add_to(ValueHash& hash) const;
    void scale(const Spectrum& factor) { intensity *= factor; }
    LightPoint point() const { return {.position = position, .strength = intensity}; }
    std::vector<AimedSource> aim(const Surroundings& scene) const;
    std::optional<Ray> send(const Surroundings& scene, const AimedSource& source,
                            const AimedSample& sample, Rng& rng) const;
    std::optional<LightArrival> arrival(const Surroundings& scene, const Vec3& at, Rng& rng) const;
    MitsubaEmitter to_mitsuba() const;
    PovrayLight to_povray(const Surroundings& scene) const;
};

}  // namespace caustics
