#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "beamtree/beams/beam.h"
#include "beamtree/light/test_plane.h"

namespace caustics::beamtree {

/// A point inside (a triangle of) a beam.
struct BeamHit {
    std::uint32_t set = 0;
    std::uint32_t beam = 0;
    std::uint8_t triangle = 0;
    /// -1 or 1: has the beam passed through its caustic or not; 0 where roots are searched and its straight-sided image
    /// does not hold the point.
    std::int8_t winding = 1;
    bool has_roots = false;  ///< the light is that of all its roots (RootSearch)
    Vec3 plane_normal;       ///< of the plane of the caustic polygon
    Vec3 weights;            ///< barycentric, of the triangle's corners: where the light left
    double area = 0;         ///< of the caustic polygon [m^2], see test_beam
    double flux_share = 1;   ///< of the beam's flux that falls on it
    double coverage = 1;     ///< of a cell round the point; 1 where the point itself is asked
    /// Covariances of the weights (1, 2), (2, 0) and (0, 1) over the part of the cell that is covered; 0 where the
    /// point itself is asked.
    Vec3 covariances = Vec3::Zero();
    /// Where the middle of that part lies, from the point, and the cell's radius [m]; 0: the point itself is asked.
    Vec3 offset = Vec3::Zero();
    float cell_radius = 0;
    /// Of a beam that drifts: the places in its bin of wavelengths between which it holds the point.
    double from = 0;
    double to = 0;

    double place() const { return (from + to) / 2; }
    /// Whether the mean over a cell is asked for, of which this is a part.
    bool is_part_of_cell() const { return cell_radius > 0; }
};

/// Does the point that the plane goes through lie inside the beam? Writes up to two hits (a polygon
/// of four corners may fold over) with their triangle, winding, weights, area and share, and returns
/// how many.
///
/// Half-open crossing rule: an edge that two triangles share is met by exactly one of them, and the
/// windings of a mesh add up to the winding of its boundary, whatever the rounding, because both
/// sides compute the edge from the same bits. Rays that do not come down to the plane, and polygons
/// that the plane cuts, are clipped at it. Where the light comes down more than twice as steeply in
/// one corner as in another, the polygon's light is uneven, and the area is the one with which
/// share / area is the density at the point.
int test_beam(const BeamSet& set, const Beam& beam, const TestPlane& plane,
              std::array<BeamHit, 2>& hits);
/// The same for copies of the beam's rays, the last of which is null where it has three corners; appends the hits.
int test_beam(const std::array<const VertexRay*, 4>& rays, const Beam& beam, const TestPlane& plane,
              std::vector<BeamHit>& hits);

/// The same of one triangle by its three rays; whether it was appended.
bool test_triangle(const std::array<const VertexRay*, 3>& rays, std::size_t number,
                   const TestPlane& plane, std::vector<BeamHit>& hits);

/// One triangle of three rays at the point that the plane goes through; `number` is the triangle's.
std::optional<BeamHit> test_triangle(const std::array<VertexRay, 3>& corners, std::size_t number,
                                     const TestPlane& plane);

/// What a search has done [CC95 sec. 3.3].
struct SearchCounts {
    std::uint64_t cone_point_tests = 0;
    std::uint64_t beam_point_tests = 0;
    std::uint64_t beam_point_hits = 0;
};

/// Where the light goes down to a plane more than this times as steeply in one corner of a polygon as in
/// another, it is not evenly lit.
inline constexpr double most_uneven = 2;

}  // namespace caustics::beamtree
