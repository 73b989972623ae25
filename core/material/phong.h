#pragma once

#include <optional>

#include "core/material/bsdf_words.h"
#include "core/material/texture.h"
#include "core/math/vec.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics {

/// Phong's lobe about the mirror direction, beside Lambert's law [C11]. `normalised` (Lafortune
/// and Willems 1994): f_r = k_d / pi + k_s (e + 2) / (2 pi) cos^e a, a the angle between wi and the
/// mirrored wo, 0 beyond a right angle; energy is kept where k_d + k_s <= 1. `classic` (Phong 1975): light
/// that arrives shines as k_s cos^e a without the cosine of its arrival, so f_r = k_d / pi +
/// k_s cos^e a / (n.wi); energy is not kept.
struct Phong {
    enum class Model { normalised, classic };
    Texture diffuse_reflectance = Spectrum(Spectrum::Constant(0.5F));   ///< k_d
    Texture specular_reflectance = Spectrum(Spectrum::Constant(0.2F));  ///< k_s
    float exponent = 30;                                                ///< e
    Model model = Model::normalised;
    float lobe_share = 0.5F;  ///< of the samples that go to the lobe; [0, 1]

    Spectrum f_r(const Vec2& uv, const Vec3& n, const Vec3& wo, const Vec3& wi) const;
    /// k_d + k_s: what is scattered of light seen straight on.
    Spectrum albedo(const Vec2& uv) const;
    Phong at(const Vec2& uv) const;
    std::optional<Vec3> sample(const Vec3& n, const Vec3& wo, const Vec3& u) const;
    float pdf(const Vec3& n, const Vec3& wo, const Vec3& wi) const;

    /// What is asked of every model of a surface; see bsdf.h.
    static ObjectText text();
    static Phong read(const JsonNode& node, scene_file::Assets& assets);
    void add_scattering_to(ValueHash& hash) const;
    std::optional<float> lobe_half_width() const;
    /// Of the model "classic": POV-Ray's highlight is the lamp's colour times cos^e a. With lamps of pi times
    /// our irradiance beneath a pigment of 1, its `phong` is pi k_s for the same light.
    PovraySurface to_povray() const;
};

}  // namespace caustics
