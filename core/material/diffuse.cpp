#include "core/material/diffuse.h"

#include "core/material/texture_reader.h"
#include "core/math/frame.h"
#include "core/math/sampling.h"

namespace caustics {

using namespace scene_file;

Spectrum Diffuse::f_r(const Vec2& uv, const Vec3&, const Vec3&, const Vec3&) const {
    return evaluate(reflectance, uv) * (1 / pi);
}

Spectrum Diffuse::albedo(const Vec2& uv) const { return evaluate(reflectance, uv); }

std::optional<Vec3> Diffuse::sample(const Vec3& n, const Vec3&, const Vec3& u) const {
    return Frame(n).to_world(cosine_hemisphere(u[0], u[1]));
}

float Diffuse::pdf(const Vec3& n, const Vec3&, const Vec3& wi) const { return n.dot(wi) / pi; }

ObjectText Diffuse::text() {
    return {"diffuse",
            "A bsdf, in a shape: Lambert's law; the default.",
            {type_key(), texture("reflectance", "Share of the light that is scattered.", "0.5")}};
}

Diffuse Diffuse::read(const JsonNode& node, Assets& assets) {
    return {read_texture(node, "reflectance", 0.5, assets)};
}

void Diffuse::add_scattering_to(ValueHash& hash) const { caustics::add_to(hash, reflectance); }

}  // namespace caustics
