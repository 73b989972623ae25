#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "tests/cruel/floor_light.h"

namespace caustics::cruel {

/// The methods, each in the way it is asked: "beamtree squares" averages over squares, "beamtree area" and
/// "beamtree refined" are asked at points.
const std::vector<std::string>& checked_methods();

/// Holds methods against particles on the floor of a scene.
class LightCheck {
public:
    /// Keeps a reference to the scene.
    LightCheck(const Scene& scene, std::uint64_t seed) : scene_(scene), seed_(seed) {}

    /// Where a method tells other light than particles do, "" where it does not: by more than five standard
    /// errors beyond what it is off by its nature, at three efforts, each 4 to 16 times the one before,
    /// with other random numbers each time. What a method cannot serve is no disagreement.
    std::string disagreement(const std::string& method);

private:
    const FloorLight& particles(int effort);

    const Scene& scene_;
    std::uint64_t seed_;
    std::vector<FloorLight> particles_;  ///< by effort, as far as they were asked for
};

}  // namespace caustics::cruel
