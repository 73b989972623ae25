#include "beamtree/beams/flux_balance.h"

#include <cmath>

#include "core/base/error.h"

namespace caustics::beamtree {
namespace {

// With most of the light missing it would be another picture.
constexpr double least_captured = 0.5;

}  // namespace

void require_most_light(const FluxBalance& balance, const std::string& method,
                        const std::string& where) {
    if (balance.captured() >= least_captured) return;
    const auto percent = std::to_string(std::lround(100 * (1 - balance.captured())));
    const bool few = balance.over_budget > balance.lost / 2;
    throw UnsupportedScene(
        method + ": beams lose " + percent + " % of the light between specular surfaces" + where +
        (few ? ", most of it in beams that max_beams has no room for (give more"
             : ", where polygons are too coarse for them (refine the casters' meshes") +
        ", give max_bounces=1 for the paths with one event alone, or use photonmap)");
}

}  // namespace caustics::beamtree
