#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/verify/agreement.h"
#include "tests/cruel/floor_light.h"

namespace caustics::cruel {

/// The methods, each in the way it is asked: "beamtree squares" averages over squares, "beamtree area" and
/// "beamtree refined" are asked at points.
const std::vector<std::string>& checked_methods();

/// What was found of a method.
struct Verdict {
    bool served = false;
    experiments::Agreement agreement = experiments::Agreement::holds;
    std::string
        text;  ///< The cell that is farthest off at each effort; empty where the method holds.
    int efforts = 0;  ///< Efforts that were needed.
    experiments::Difference
        whole;  ///< On the floor in all, at the first effort, as a share of the particles' light.
    double light = 0;  ///< Of particles on the floor in all [W/m^2], in the brightest channel.
    double cpu_seconds =
        0;  ///< CPU seconds of the method, and of the particles where it is the first that needs them.
};

/// Holds methods against particles on the floor of a scene, by the rule of `verify SCENE` (agreement.h): within 2 %
/// and five standard errors in all, and within 6 % in each of 3 x 3 squares; what does not hold is asked with 4 and
/// 16 times the work and must come within those limits.
class LightCheck {
public:
    /// Keeps a reference to the scene.
    LightCheck(const Scene& scene, std::uint64_t seed);

    Verdict verdict(const std::string& method);

private:
    const ParticleLight& particles();

    FloorAsked floor_;
    std::optional<ParticleLight> particles_;
};

}  // namespace caustics::cruel
