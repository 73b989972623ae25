#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace caustics::beamtree {

/// A diffuse polygon.
struct ReceiverPolygon {
    Vec3 a, b, c;
    Vec3 normal;  ///< unit, front side
};

/// How far from it a point that belongs to the polygon may be, because the coordinates of both are
/// floats [m].
double position_rounding(const ReceiverPolygon& polygon);

/// All receivers of a scene as polygons: meshes as they are, exact shapes tessellated. Triangles
/// without area are left out.
class ReceiverPolygons {
public:
    ReceiverPolygons(const Scene& scene, int resolution);

    const std::vector<ReceiverPolygon>& polygons() const { return polygons_; }
    /// The polygon nearest to a point of a receiver with its unit normal: among those equally near,
    /// as at a corner of a room, the one that the normal fits best. There must be one. `stack` is
    /// scratch.
    std::uint32_t nearest(const Vec3& point, const Vec3& normal,
                          std::vector<std::uint32_t>& stack) const;
    std::uint64_t bytes() const {
        return polygons_.size() * sizeof(ReceiverPolygon) + nodes_.size() * sizeof(Node);
    }

private:
    struct Node {
        Box box;
        std::uint32_t first = 0;  ///< polygon, or the first of two children
        std::uint32_t count = 0;  ///< of polygons; 0: an inner node
    };
    void build_tree();

    std::vector<ReceiverPolygon> polygons_;
    std::vector<Node> nodes_;
};

}  // namespace caustics::beamtree
