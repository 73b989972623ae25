#pragma once

#include <optional>

#include "core/material/bsdf_words.h"
#include "core/material/texture.h"
#include "core/math/vec.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics {

/// Lambert's law: f_r = reflectance / pi.
struct Diffuse {
    Texture reflectance = Spectrum(Spectrum::Constant(0.5F));

    Spectrum f_r(const Vec2& uv, const Vec3& n, const Vec3& wo, const Vec3& wi) const;
    Spectrum albedo(const Vec2& uv) const;
    Diffuse at(const Vec2& uv) const { return {evaluate(reflectance, uv)}; }
    std::optional<Vec3> sample(const Vec3& n, const Vec3& wo, const Vec3& u) const;
    float pdf(const Vec3& n, const Vec3& wo, const Vec3& wi) const;

    /// What is asked of every model of a surface; see bsdf.h.
    static ObjectText text();
    static Diffuse read(const JsonNode& node, scene_file::Assets& assets);
    void add_scattering_to(ValueHash& hash) const;
    MitsubaBsdf to_mitsuba() const { return {"diffuse", {{"reflectance", reflectance}}}; }
    PovraySurface to_povray() const { return {.pigment = reflectance}; }
};

}  // namespace caustics
