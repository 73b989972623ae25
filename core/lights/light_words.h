#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/geometry/segment.h"
#include "core/lights/spot_cone.h"
#include "core/math/spectrum.h"

namespace caustics {

/// A light as one point, or one direction from far away, that all its light comes from.
struct LightPoint {
    std::optional<Vec3> position = {};
    Vec3 travel = Vec3::Zero();   ///< unit, the way the light goes, where there is no position
    Spectrum strength = black();  ///< [W/sr]; from far away on a plane across it [W/m^2]
    std::optional<SpotCone> spot = {};
};

/// What comes straight to a place from a point of a light.
struct LightArrival {
    Vec3 wi = Vec3::UnitZ();             ///< unit, to the light
    std::optional<SegmentEnd> end = {};  ///< on the light; none: it is far away
    Spectrum strength = black();         ///< radiance of an area light; else [W/sr] or [W/m^2]
    float divisor = 1;     ///< density of an area light's point [1/sr]; else squared distance
    bool is_delta = true;  ///< no direction chosen at random would meet it
};

/// A light as Mitsuba writes it.
struct MitsubaEmitter {
    struct Value {
        std::string type;  ///< of the element
        std::string name;
        std::variant<double, Vec3> value;
    };
    std::string type;
    std::vector<Value> values;
    std::optional<Eigen::Matrix4d> to_world = {};
};

/// A light as POV-Ray knows it, or why it does not. A surface of pigment p under light of colour c is
/// p c cos(theta) bright there, and p E / pi in truth; light fades by 2 / (1 + (d / fade_distance)^2), which
/// is the inverse square for a fade_distance that is nothing beside d.
struct PovrayLight {
    Vec3 from = Vec3::Zero();
    SpectrumSum colour = SpectrumSum::Zero();
    std::optional<double> fade_distance = {};
    std::optional<Vec3> point_at = {};  ///< of parallel light
    std::string name = {};              ///< where it is refused: what
    std::string refused = {};           ///< and why
};

}  // namespace caustics
