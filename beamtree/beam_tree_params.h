#pragma once

#include <string>

#include "beamtree/beams/beam_params.h"
#include "beamtree/cones/cone_tree.h"
#include "beamtree/tracing/beam_tracing.h"

namespace caustics::beamtree {

/// `beamtree` [CC95]: the light that each specular polygon sends on is a beam; the beams of each
/// light are found from a receiver point through a tree of cones. The defaults are what is nearest to
/// the truth in a given time; `chuang1995` is what the paper says.
struct BeamTreeParams : BeamParams {
    enum class Tree {
        quadtree,  ///< of a regular subdivision; casters that have none get `binned`, and the report
                   ///< reports how many
        binned
    };
    enum class Leaf {
        receiver,  ///< caustic polygons on the plane across the receiver's normal, as the paper says
        fixed      ///< on planes across a normal fixed for the tree
    };
    enum class Rest {
        none,       ///< light that `prune` and `max_beams` leave out is lost
        max_beams,  ///< photons carry what `max_beams` leaves out
        photons,    ///< and what `prune` does, or polygons too coarse for what they meet
        pencils     ///< as `max_beams`; beams carry light of few events, and pencils all other
    };
    std::string preset = {};  ///< name of the settings that were taken in place of the defaults
    Bound bound = Bound::two_slice;
    double spread_threshold = 10;  ///< of `hybrid` [degrees]
    ConeTreeSettings::Merging merging = ConeTreeSettings::Merging::rays;
    Tree hierarchy = Tree::binned;
    Leaf leaf = Leaf::fixed;  ///< with two_slice always
    Intensity intensity = Intensity::refined;
    /// Rays of light of up to so many events are searched one by one at points (`refined`). Light of more events is spread
    /// over the images of its polygons.
    int root_events = TraceSettings{}.root_events;
    /// Side of the square round each point, on its tangent plane along PlaneAxes, over which its irradiance is averaged
    /// exactly [m]; 0: at the point alone. Only with the bound two_slice; beams that spread too far for
    /// a fixed plane, and polygons that the plane cuts, are asked at the point.
    float footprint = 0;
    /// The same over the cell of the pixel or its stratum that a point stands for, where the camera sees it directly.
    bool pixel_footprint = true;
    Rest rest = Rest::pencils;
    static constexpr int planned = -1;
    /// With `pencils`: beams carry the light of up to so many events, or of as many as are worth it (beam_plan.h).
    int beam_events = planned;
    std::int64_t pencils = 200'000;  ///< over all lights and casters
    std::int64_t rest_photons =
        300'000;            ///< paths for all light on casters; what is left out has its share
    int rest_nearest = 50;  ///< photons that a photon's disc reaches to

    /// The settings of [CC95]: hybrid cones, merged from their children's, over the caster's own
    /// subdivision; flux over the area of caustic polygons across the receiver's normal.
    static BeamTreeParams chuang1995() {
        BeamTreeParams params;
        params.bound = Bound::hybrid;
        params.merging = ConeTreeSettings::Merging::cones;
        params.hierarchy = Tree::quadtree;
        params.leaf = Leaf::receiver;
        params.intensity = Intensity::area;
        params.max_bounces = preset_bounces;
        params.rest = Rest::none;
        params.pixel_footprint = false;
        return params;
    }
};

}  // namespace caustics::beamtree
