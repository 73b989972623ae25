#pragma once

#include "core/lights/aimed_source.h"
#include "core/lights/light_words.h"
#include "core/math/value_hash.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics {

/// The same radiance from everywhere, from infinitely far away (Mitsuba's `constant`). Its
/// members: light.h.
struct ConstantLight {
    Spectrum radiance = Spectrum::Ones();  ///< [W m^-2 sr^-1]

    static constexpr int family = 3;
    static ObjectText text();
    static ConstantLight read(const JsonNode& node, const Vec3d& origin);

    std::string line(const Surroundings& scene, const Vec3d& origin) const;
    void add_to(ValueHash& hash) const { hash.add(radiance); }
    void scale(const Spectrum& factor) { radiance *= factor; }
    Spectrum background() const { return radiance; }
    std::vector<AimedSource> aim(const Surroundings& scene) const;
    std::optional<Ray> send(const Surroundings& scene, const AimedSource& source,
                            const AimedSample& sample, Rng& rng) const;
    MitsubaEmitter to_mitsuba() const;
    PovrayLight to_povray(const Surroundings& scene) const;
};

}  // namespace caustics
