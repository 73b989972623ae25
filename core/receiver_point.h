#pragma once

#include <cstdint>
#include <optional>

#include "core/material/bsdf.h"
#include "core/pixel_cell.h"
#include "core/scene/scene.h"

namespace caustics {

/// A point of a receiver as a viewer sees it. Normals are on the viewer's side.
struct ReceiverPoint {
    Vec3 position = Vec3::Zero();
    Vec3 geometric_normal = Vec3::Zero();  ///< unit
    Vec3 shading_normal = Vec3::Zero();    ///< unit
    Vec3 wo = Vec3::Zero();                ///< unit, away from the surface towards the viewer
    Vec2 uv = Vec2::Zero();
    float offset = 0;            ///< as SurfacePoint::offset
    const Bsdf* bsdf = nullptr;  ///< of the receiver; not read by irradiance()
    std::uint32_t shape = 0;     ///< index into Scene::shapes
    bool front = true;           ///< whether the viewer is on the front side of the surface
    float nm = 0;                ///< wavelength that glass before the viewer has chosen; 0: none
    /// Absorption [1/m] of the medium on that side; null: as far as is known, none.
    const Spectrum* medium = nullptr;
    std::uint64_t id = 0;  ///< names the point's random numbers
    float radius = 0;      ///< of the disc that `lighttrace` gathers over [m]
    /// The camera sample's part of the picture, for methods that ask for it; null: there is none.
    const PixelCell* cell = nullptr;
};

/// The receiver point at a surface point, seen along `wo`; its normals are turned to that side.
/// Empty where the surface is no receiver or black on that side.
std::optional<ReceiverPoint> receiver_point(const Scene& scene, const SurfacePoint& point,
                                            const Vec3& wo);

/// The point with a white Lambertian surface, seen along its geometric normal: pi times what it reflects is
/// the point's irradiance.
ReceiverPoint white_point(ReceiverPoint point);

}  // namespace caustics
