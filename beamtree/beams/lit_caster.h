#pragma once

#include <cstdint>
#include <string>

#include "beamtree/beams/caster_mesh.h"
#include "beamtree/beams/specular_vertex.h"

namespace caustics::beamtree {

/// How a triangle of a caster's mesh stands to the light.
struct Facing {
    Vec3 normal;  ///< unit, by the winding
    bool front;   ///< the light arrives on its front
    bool hidden;  ///< and no light can come to that side
};

/// Whether the light that arrives at a point of a triangle leaves by the event. The rule of
/// split_specular, for a point whose light was bent by the vertex normal alone: the light must come
/// to the same side of both normals, and leave on the right side of both.
bool sends_on(const MeshPoint& point, const Facing& facing, Event event);

/// Whether a surface is flat from one point to another, by its unit normals there.
bool is_flat_between(const Vec3& normal, const Vec3& other);

/// How far off a triangle rays to and from its corners end, so that they do not meet it [m].
float corner_offset(const TriangleMesh& mesh, std::uint32_t triangle);

/// A caster's mesh in the light of one sample.
class LitCaster {
public:
    LitCaster(const Scene& scene, const CasterMesh& caster, const LightSample& light);

    const CasterMesh& caster() const { return caster_; }
    const LightSample& light() const { return light_; }
    const Bsdf& bsdf() const { return bsdf_; }
    const LightBender& bender() const { return bender_; }
    const std::string& name() const { return scene_.shapes()[caster_.shape].name; }
    /// A place of the scene's frame, in the world [m].
    Vec3d world(const Vec3& place) const { return scene_.origin() + place.cast<double>(); }
    Facing facing(std::uint32_t triangle) const;
    float corner_offset(std::uint32_t triangle) const {
        return beamtree::corner_offset(caster_.mesh, triangle);
    }
    /// The same for points inside of it, which lie below an exact shape's surface.
    float offset(std::uint32_t triangle) const;

private:
    const Scene& scene_;
    const CasterMesh& caster_;
    const LightSample& light_;
    const Bsdf& bsdf_;
    LightBender bender_;
    ClosedParts::Hidden hidden_;
};

}  // namespace caustics::beamtree
