#pragma once

#include <array>
#include <optional>
#include <vector>

#include "beamtree/beams/beam.h"
#include "beamtree/light/first_polygon.h"
#include "beamtree/light/image_model.h"
#include "beamtree/light/light_chain.h"

namespace caustics::beamtree {

/// A place of the first surface from which light reaches a point, and how dense it is there.
struct Root {
    Vec3d first;  ///< on the first surface
    double edge_room =
        0;  ///< on an edge of its polygon: the neighbour may have found it as well, within this [m]
    SegmentEnd start;           ///< on the last surface
    Vec3 direction;             ///< unit, the way from there to the point
    Spectrum weight = black();  ///< strength of the light after all events
    double density =
        0;  ///< of the light's measure, for an area across the direction [sr m^-2, or 1]
};

/// Finds all rays of a beam that reach a point: the specular point and its energy that [CC95 sec. 5] leave for later.
/// A ray belongs to the polygon that holds its *preimage* on the first surface, not to the polygon whose
/// straight-sided image covers the point: chords of a fold lie inside the fold, where light is brightest. Newton's
/// method goes on from where a model of the beam's image reaches the point.
class RootSearch {
public:
    /// Scene and set outlive this; the set has middles.
    RootSearch(const Scene& scene, const BeamSet& set);

    /// Appends the roots of one of a beam's triangles whose light is not blocked before it leaves the last surface.
    /// False where the image holds the point for sure, and no root was found.
    bool find(std::uint32_t beam, std::size_t triangle, const Vec3& point,
              std::vector<Root>& roots) const;

private:
    /// A solution of Newton's method.
    struct Found {
        Vec2d at;  ///< on the polygon
        ChainRay ray;
        Eigen::Matrix2d change;  ///< of the miss
        double density;
    };
    struct Image;
    struct Partners {
        std::array<Vec2d, 2> at;
        std::size_t count = 0;
    };
    /// By Newton's method. Steps to where the light does not go the set's way are halved.
    std::optional<Found> polish(const Image& image, Vec2d at) const;
    /// Beside a fold two rays reach the point, and beside a cusp three: where the others may be.
    Partners partners(const Image& image, const Found& found) const;
    void add(const FirstPolygon& polygon, const Found& found, std::vector<Root>& roots) const;

    const Scene& scene_;
    const BeamSet& set_;
    LightChain chain_;
    std::optional<SpecularSurface> exact_;
    bool meets_mesh_;  ///< after the first event
};

}  // namespace caustics::beamtree
