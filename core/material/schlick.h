#pragma once

#include <optional>

#include "core/material/texture.h"
#include "core/math/vec.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics {

/// Schlick's model as [J96 (5)], [J96 (6)] print it, times `reflectance`, without anisotropy and
/// without Fresnel; alpha = 1 is broad, alpha -> 0 a mirror-like lobe. The printed t is always
/// +-1; here t = n.h with the normalised half vector. Not Lambertian at alpha = 1: the albedo
/// there is 5/4 - 2v/3, v = n.wo.
struct Schlick {
    Texture reflectance = Spectrum(Spectrum::Constant(0.5F));
    float alpha = 1;  ///< (0, 1]

    Spectrum f_r(const Vec2& uv, const Vec3& n, const Vec3& wo, const Vec3& wi) const;
    Spectrum albedo(const Vec2& uv) const;
    Schlick at(const Vec2& uv) const { return {evaluate(reflectance, uv), alpha}; }
    /// Half of the samples by the cosine, half by the half-vector lobe Z(t).
    std::optional<Vec3> sample(const Vec3& n, const Vec3& wo, const Vec3& u) const;
    float pdf(const Vec3& n, const Vec3& wo, const Vec3& wi) const;

    /// What is asked of every model of a surface; see bsdf.h.
    static ObjectText text();
    static Schlick read(const JsonNode& node, scene_file::Assets& assets);
    void add_scattering_to(ValueHash& hash) const;
    std::optional<float> lobe_half_width() const;
};

}  // namespace caustics
