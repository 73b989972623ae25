#pragma once

#include <array>
#include <optional>

#include "beamtree/light/beam_point.h"
#include "beamtree/slices/slice_frame.h"
#include "core/pixel_cell.h"

namespace caustics::beamtree {

/// A cell with its plane. Coordinates are from the point, along the cell's axes.
struct BeamSquare {
    TestPlane plane;
    const PixelCell* cell = nullptr;
    /// What lies inside has outward . p <= limit for each side.
    std::array<Vec2d, 4> outward = {};
    std::array<double, 4> limit = {};
    double area = 0;  ///< as the camera shows it

    /// Empty for a cell without area.
    static std::optional<BeamSquare> at(const Vec3& point, const PixelCell& cell);
};

/// How far a cell reaches from its point [m]: down from the frame's plane through it, and, along both axes, on that
/// plane where the cell's light passes it. The light comes down to the plane at a sine of least_sine or more
/// (fixed_planes).
struct CellReach {
    Vec2d across = Vec2d::Zero();
    double down = 0;
};
CellReach reach_of(const PixelCell& cell, const SliceFrame& frame);

/// The part of a beam's caustic polygon that lies on the square. Appends a hit
/// for each of the beam's triangles that has one, with the share of the square it covers, and the
/// middle of that part as the place where the light left. Polygons that the trees' plane cuts are taken on the
/// receiver's plane, and those that this cuts, too, or that run towards the horizon, are asked at the point as in find_in_beam.
/// `rays` are the beam's or copies of them (test_beam).
void find_on_square(const BeamSet& set, const std::array<const VertexRay*, 4>& rays,
                    const BeamNumber& number, const TestPlane& trees_plane,
                    const BeamSquare& square, std::vector<BeamHit>& hits, SearchCounts& counts);

}  // namespace caustics::beamtree
