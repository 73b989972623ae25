#include "core/material/dielectric.h"

namespace caustics {

float Dielectric::relative_ior(bool front, float nm) const {
    if (is_dispersive()) {
        const double ratio = int_ior.at(nm) / ext_ior.at(nm);
        return static_cast<float>(front ? ratio : 1 / ratio);
    }
    const auto inside = static_cast<float>(int_ior.n());
    const auto outside = static_cast<float>(ext_ior.n());
    return front ? inside / outside : outside / inside;
}

}  // namespace caustics
