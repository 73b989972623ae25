#include "core/receiver_point.h"

namespace caustics {

std::optional<ReceiverPoint> receiver_point(const Scene& scene, const SurfacePoint& point,
                                            const Vec3& wo) {
    const Bsdf& bsdf = scene.shape_at(point).bsdf;
    const bool front = point.geometric_normal.dot(wo) > 0;
    if (!is_receiver(bsdf) || !scatters_from(bsdf, front)) return {};
    ReceiverPoint receiver;
    receiver.position = point.position;
    receiver.geometric_normal = front ? point.geometric_normal : Vec3(-point.geometric_normal);
    receiver.shading_normal = front ? point.shading_normal : Vec3(-point.shading_normal);
    receiver.wo = wo;
    receiver.uv = point.uv;
    receiver.offset = point.offset;
    receiver.bsdf = &bsdf;
    receiver.shape = point.shape;
    receiver.front = front;
    return receiver;
}

ReceiverPoint white_point(ReceiverPoint point) {
    static const Bsdf white{Diffuse{Spectrum(Spectrum::Ones())}};
    point.bsdf = &white;
    point.shading_normal = point.wo = point.geometric_normal;
    return point;
}

}  // namespace caustics
