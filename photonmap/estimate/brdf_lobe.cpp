#include "photonmap/estimate/brdf_lobe.h"

#include "core/math/frame.h"

namespace caustics::photonmap {

namespace {

template <typename Three>
void copy(const Three& from, float (&to)[3]) {
    for (int i = 0; i < 3; ++i) to[i] = from[i];
}

Lobe lobe_of(const Vec3& normal, const Vec3& wo, float alpha) {
    const Frame frame(normal);
    Lobe lobe{};
    copy(normal, lobe.normal);
    copy(frame.s, lobe.tangent);
    copy(frame.t, lobe.bitangent);
    copy(wo, lobe.wo);
    // In double: at grazing angles rounding would be felt.
    lobe.cosine = static_cast<float>(normal.cast<double>().dot(wo.cast<double>()));
    lobe.alpha = alpha;
    return lobe;
}

}  // namespace

BrdfLobe reflection_of(const ReceiverPoint& point) {
    BrdfLobe reflection;
    const Vec3& n = point.shading_normal;
    if (!(n.dot(point.wo) > 0)) return reflection;
    if (const auto* diffuse = std::get_if<Diffuse>(&point.bsdf->model)) {
        reflection.model = BrdfLobe::Model::lambert;
        copy(n, reflection.lobe.normal);
        reflection.scale = evaluate(diffuse->reflectance, point.uv).cast<double>() / pi_d;
    } else if (const auto* schlick = std::get_if<Schlick>(&point.bsdf->model)) {
        reflection.model = BrdfLobe::Model::schlick;
        reflection.lobe = lobe_of(n, point.wo, schlick->alpha);
        const auto cosine = static_cast<double>(reflection.lobe.cosine);
        const auto alpha = static_cast<double>(schlick->alpha);
        reflection.scale = evaluate(schlick->reflectance, point.uv).cast<double>() * alpha /
                           (pi_d * (cosine + alpha * (1 - cosine)));
    } else if (const auto* phong = std::get_if<Phong>(&point.bsdf->model);
               phong != nullptr && phong->model == Phong::Model::normalised) {
        reflection.model = BrdfLobe::Model::phong;
        copy(n, reflection.lobe.normal);
        const Vec3d normal = n.cast<double>();
        const Vec3d wo = point.wo.cast<double>();
        copy((2 * normal.dot(wo) * normal - wo).normalized().cast<float>(),
             reflection.lobe.mirrored);
        reflection.lobe.exponent = phong->exponent;
        reflection.scale = SpectrumSum::Ones();
        copy(evaluate(phong->diffuse_reflectance, point.uv) / pi, reflection.lobe.diffuse);
        copy(evaluate(phong->specular_reflectance, point.uv) * (phong->exponent + 2) / (2 * pi),
             reflection.lobe.specular);
    } else {
        reflection.model = BrdfLobe::Model::other;
        reflection.scale = SpectrumSum::Ones();
        return reflection;
    }
    if (const auto& mirror = point.bsdf->mirror)
        reflection.scale *= 1 - static_cast<double>(mirror->weight);
    return reflection;
}

}  // namespace caustics::photonmap
