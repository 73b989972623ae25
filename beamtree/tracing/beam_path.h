#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "beamtree/beams/lit_caster.h"
#include "beamtree/beams/ray_origin.h"
#include "beamtree/light/specular_surface.h"
#include "beamtree/tracing/ray_arrival.h"

namespace caustics::beamtree {

/// One more event on a beam's way, after the first.
struct Step {
    const RayArrival* where;  ///< of one of the beam's corners
    Event event;
};

/// A set on its way, with what its light has done before.
struct Level {
    const Level* parent = nullptr;
    Event event = reflection;  ///< its last
    TracedSet traced;
    std::vector<Departure> departures;  ///< one a ray
    std::vector<RayArrival> arrivals;   ///< one a ray, once it is followed
    /// One a beam, but for the first level: the beam it comes from, and a place where its light was bent.
    std::vector<std::uint32_t> parents;
    std::vector<RayArrival> places;
    /// One a beam, or none where all are 1: what division for detail (piece_detail.h) has left of the polygon.
    std::vector<float> shares;
    /// The exact first surface, on which ways between corners begin; null: they begin on the polygons.
    const SpecularSurface* exact = nullptr;
    /// Of its beams, were the media clear and they not divided: what they are worth following for [W].
    double worth = 0;

    std::size_t bounces() const { return traced.set.path.size(); }
};

/// The light of one point of the first surface, after the steps of some path.
struct PathPoint {
    RayOrigin origin;
    Departure from;
    VertexRay ray;
    bool alive = false;  ///< it has gone that path
    RayArrival next;
};

using Piece = std::array<PathPoint, 3>;

/// The way of a beam, to be gone again from other points of its triangle.
class Path {
public:
    Path(const Scene& scene, const LitCaster& surface, const Level& level, std::uint32_t beam);

    /// (1 - t) a + t b on the first surface.
    PathPoint between(const PathPoint& a, const PathPoint& b, float t) const;
    /// The point with these barycentric weights.
    PathPoint inside(const std::array<const RayOrigin*, 3>& corners, const Vec3& weights) const;
    PathPoint middle(const Piece& piece) const;
    /// The place that a ray has come from, with its light as it leaves the last step; where that arrives (`next`) is not
    /// asked. `by_facets`: by the very facets of the steps, where those are shaded flat.
    PathPoint from(const RayOrigin& origin, bool by_facets = false) const {
        return go_steps(origin.position, origin.normal, origin.offset, by_facets);
    }

private:
    PathPoint go(const Vec3& position, const Vec3& normal, float offset) const;
    PathPoint go_steps(const Vec3& position, const Vec3& normal, float offset,
                       bool by_facets) const;
    PathPoint go_steps(const Vec3& position, const Vec3& normal, float offset, const Facing& facing,
                       bool by_facets) const;

    const Scene& scene_;
    const LitCaster& surface_;
    Facing facing_;
    const SpecularSurface* exact_ = nullptr;  ///< as Level::exact
    float exact_offset_ = 0;                  ///< of places on it [m]
    Event first_event_;
    std::vector<Step> steps_;
};

}  // namespace caustics::beamtree
