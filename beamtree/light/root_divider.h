#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "beamtree/light/first_polygon.h"
#include "beamtree/light/light_chain.h"

namespace caustics::beamtree {

/// A beam, or a part of one, with its edges' middles.
struct RootBeam {
    Beam beam;
    std::uint32_t from = 0;  ///< the beam of the set that it is, or is part of
    bool is_part = false;
    std::array<EdgeMiddles, 2> middles = {no_middles(), no_middles()};

    /// Rays without a direction, of a triangle that a beam does not have.
    static EdgeMiddles no_middles() {
        const VertexRay none{Vec3::Zero(), Vec3::Zero()};
        return {none, none, none};
    }
};

/// The prepared beams of a part of a set. Rays of new corners are numbered from the set's last ray on.
struct RootBeams {
    std::vector<RootBeam> beams;
    std::vector<VertexRay> rays;
    std::vector<Vec3> origins;
};

/// Corners of a triangle, in its own coordinates.
inline const std::array<Vec2d, 3> unit_corners = {Vec2d(0, 0), Vec2d(1, 0), Vec2d(0, 1)};

/// A place of a triangle, with its ray.
struct RootNode {
    Vec2d at;
    Vec3 origin;  ///< in the polygon's plane
    VertexRay ray;
    bool is_lit = true;                 ///< light of it goes the set's way
    Vec3d facets = Vec3d::Zero();       ///< that it meets (ChainRay::facets)
    std::uint32_t number = Beam::none;  ///< of the ray, where it is a corner
};

/// Divides one triangle of a beam, where a quadratic of its edges' middles is not good enough or the horizon cuts it.
class RootDivider {
public:
    /// New rays are numbered from `first_number` on. `meets_mesh` says that the light meets a mesh after the first surface, so that
    /// the border of the lit part of a triangle may have corners.
    RootDivider(const LightChain& chain, const FirstPolygon& polygon, double reach, bool meets_mesh,
                std::uint32_t first_number, RootBeams& out)
        : chain_(chain),
          polygon_(polygon),
          reach_(reach),
          meets_mesh_(meets_mesh),
          first_number_(first_number),
          out_(out) {}

    /// A triangle with a dark part, and a place whose light goes the set's way.
    void add_cut(const RootBeam& beam, const std::array<Vec3, 3>& origins, const Vec2d& lit);

    /// Gives corners whose rays go other ways than rays of the triangle rays of their own: a corner at a tip of the next
    /// surface has one ray for all triangles round it. True where one has got its own.
    bool take_own_rays(std::array<RootNode, 3>& corners);

    /// A triangle whose corners' rays are known: quartered at most so often.
    void divide(const std::array<RootNode, 3>& corners, const RootBeam& beam, int quarters);

private:
    static std::array<std::array<RootNode, 3>, 4> quartered(const std::array<RootNode, 3>& corners,
                                                            const std::array<RootNode, 3>& m);
    // The parts that have light share the beam's flux; false if there are none. `lit`: see add_cut.
    bool divide_cut(const std::array<RootNode, 3>& corners, const RootBeam& beam,
                    const std::optional<Vec2d>& lit, int quarters);
    // A part that is dark all along its edges is left out, unless it has the place `lit`. One that is lit there is like any
    // other beam.
    void cut(const std::array<RootNode, 3>& corners, RootBeam beam, const std::optional<Vec2d>& lit,
             int quarters);
    // How often light begins or ends to go the set's way round a triangle.
    static int changes(const std::array<RootNode, 12>& edges);
    // Adds the lit part of a triangle that the horizon cuts once. False where that part is not known well enough.
    bool add_lit_side(const std::array<RootNode, 3>& corners, const RootBeam& beam);
    // Adds a triangle whose second edge is a chord of the horizon. A sliver beyond that chord is lit too.
    bool add_to_horizon(const std::array<RootNode, 3>& corners, const RootBeam& beam);
    void add_lit(std::array<RootNode, 3> corners, const RootBeam& beam);
    static bool holds(const std::array<RootNode, 3>& corners, const Vec2d& at);
    // The rays of dark places are those of the last lit ones towards them.
    void add_dark(std::array<RootNode, 3> corners, const RootBeam& beam, const Vec2d& lit);
    // The last place from a lit one towards a dark one of which the light goes the set's way.
    RootNode horizon(const Vec2d& lit, const Vec2d& dark) const;
    // Its ray starts a little inside the triangle: an edge may lie along one of the next surface, behind which normals are
    // another facet's.
    RootNode node(const Vec2d& at) const;
    RootNode between(const RootNode& a, const RootNode& b) const;
    // True where the triangle's middles meet different facets after the first surface.
    static bool meet_facets(const std::array<RootNode, 3>& middles);
    double light_area(const std::array<RootNode, 3>& corners) const;
    static bool are_lit(const std::array<RootNode, 3>& nodes);
    // A quarter along an edge, where a cubic is off its quadratic most.
    RootNode quarter(const RootNode& a, const RootNode& b) const;
    // `quarter_nodes`: of the three edges.
    bool is_rough(const std::array<RootNode, 3>& corners, const std::array<RootNode, 3>& middles,
                  const std::array<RootNode, 3>& quarter_nodes) const;
    void number(RootNode& node);
    void add(const std::array<RootNode, 3>& corners, const std::array<RootNode, 3>& middles,
             const RootBeam& beam);

    const LightChain& chain_;
    const FirstPolygon& polygon_;
    double reach_;
    bool meets_mesh_;
    std::uint32_t first_number_;
    RootBeams& out_;
};

}  // namespace caustics::beamtree
