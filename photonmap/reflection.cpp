#include "photonmap/reflection.h"

#include <cmath>

namespace caustics {

namespace {

void copy(const Vec3& from, float (&to)[3]) {
    for (int i = 0; i < 3; ++i) to[i] = from[i];
}

/// Sines below this leave the plane of n and wo undefined.
constexpr double smallest_sine = 1e-9;

Lobe lobe_of(const Vec3& normal, const Vec3& wo, float cosine, float alpha) {
    // In double, because the difference cancels where wo is nearly the normal.
    const Vec3d n = normal.cast<double>();
    const Vec3d across = wo.cast<double>() - n * (n.dot(wo.cast<double>()) / n.squaredNorm());
    const double sine = across.norm();
    const Vec3d tangent = sine > smallest_sine ? Vec3d(across / sine) : n.unitOrthogonal();
    Lobe lobe{};
    copy(normal, lobe.normal);
    copy(tangent.cast<float>(), lobe.tangent);
    copy(n.cross(tangent).cast<float>(), lobe.bitangent);
    lobe.cosine = cosine;
    lobe.sine = static_cast<float>(sine);
    lobe.alpha = alpha;
    return lobe;
}

}  // namespace

Reflection reflection_of(const ReceiverPoint& point) {
    Reflection reflection;
    const Vec3& n = point.shading_normal;
    const float v = n.dot(point.wo);
    if (!(v > 0)) return reflection;
    if (const auto* diffuse = std::get_if<Diffuse>(&point.bsdf->model)) {
        reflection.model = Reflection::Model::lambert;
        copy(n, reflection.lobe.normal);
        reflection.scale = evaluate(diffuse->reflectance, point.uv).cast<double>() / pi_d;
    } else if (const auto* schlick = std::get_if<Schlick>(&point.bsdf->model)) {
        reflection.model = Reflection::Model::schlick;
        reflection.lobe = lobe_of(n, point.wo, v, schlick->alpha);
        const auto cosine = static_cast<double>(v), alpha = static_cast<double>(schlick->alpha);
        reflection.scale = evaluate(schlick->reflectance, point.uv).cast<double>() * alpha /
                           (pi_d * (cosine + alpha * (1 - cosine)));
    } else {
        reflection.model = Reflection::Model::other;
        reflection.scale = SpectrumSum::Ones();
    }
    return reflection;
}

}  // namespace caustics
