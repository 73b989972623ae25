#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace caustics::experiments {

/// Where the light of one light goes that it sends towards casters, by paths traced to find out [W], mean of
/// the channels.
struct LightAccount {
    std::string light;
    std::string nothing_aimed;  ///< why no light is sent towards a caster; empty when some is
    double sent = 0;
    double missed = 0;    ///< met no caster
    double escaped = 0;   ///< left the scene after one
    double absorbed = 0;  ///< by casters and media
    double on_black_side = 0;
    double depth_limited = 0;
    double arrived = 0;  ///< on receivers
    double arrived_error = 0;
    /// The same where every branch is followed with its weight, instead of one by chance.
    double arrived_by_branches = 0;
    double branches_error = 0;

    /// Both figures of what arrived agree within five of their errors, no more arrived than was sent, and
    /// nothing is negative beyond that.
    bool holds() const;
};

/// One account for each light, alone in the scene.
std::vector<LightAccount> audit_lights(const SceneDesc& scene, int max_bounces);

}  // namespace caustics::experiments
