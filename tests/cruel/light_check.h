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

/// What was found of a method.
struct Verdict {
    /// Where it tells other light than particles do, "" where it does not: by more than five standard errors
    /// beyond what it is off by its nature, at the third effort and at those before that were sure enough. Each
    /// is 4 to 16 times the one before, with other random numbers. What a method cannot serve is no disagreement.
    std::string disagreement;
    bool served = false;
    int efforts = 0;  ///< that were needed
    /// At the last of them, of the floor in all, in the brightest channel.
    Measured light;
    Measured of_particles;
};

/// Holds methods against particles on the floor of a scene.
class LightCheck {
public:
    /// Keeps a reference to the scene.
    LightCheck(const Scene& scene, std::uint64_t seed) : scene_(scene), seed_(seed) {}

    Verdict verdict(const std::string& method);

private:
    const FloorLight& particles(int effort);

    const Scene& scene_;
    std::uint64_t seed_;
    std::vector<FloorLight> particles_;  ///< by effort, as far as they were asked for
};

}  // namespace caustics::cruel
