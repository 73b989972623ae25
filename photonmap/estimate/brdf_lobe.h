#pragma once

#include "core/caustic_estimator.h"
#include "photonmap/kernels/shading_kernel.h"

namespace caustics::photonmap {

/// The f_r of a receiver point seen along its `wo`, taken apart for shading many photons:
/// f_r(wi) = `scale` x a factor of wi that a kernel works out.
struct BrdfLobe {
    enum class Model {
        black,    ///< no light reaches the viewer
        lambert,  ///< the kernel `facing`
        schlick,  ///< the kernel `schlick`
        phong,    ///< the kernel `phong`
        other     ///< evaluate(bsdf, ...), photon by photon
    };
    Model model = Model::black;
    Lobe lobe{};
    SpectrumSum scale = SpectrumSum::Zero();  ///< holds the reflectance at the point, but for Phong
};

/// The point's texture is evaluated here, once.
BrdfLobe reflection_of(const ReceiverPoint& point);

}  // namespace caustics::photonmap
