#include "beamtree/caustic_edges.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

namespace caustics::beamtree {
namespace {

/// Place and direction of a ray. Beams that share a point share these bits, even where a cut has
/// given each a ray of its own.
using RayBits = std::array<float, 6>;

RayBits bits(const VertexRay& ray) {
    const Vec3& p = ray.position;
    const Vec3& d = ray.direction;
    return {p.x(), p.y(), p.z(), d.x(), d.y(), d.z()};
}

struct Arrival {
    Vec3 position;
    std::uint32_t shape;
};

/// Of one set of beams.
class EdgeCollector {
public:
    EdgeCollector(const Scene& scene, const TriangleMesh& first, const BeamSet& set)
        : scene_(scene), first_(first), set_(set) {
        for (const SpecularEvent& event : set.path) mirrored_ ^= !event.refracted;
    }

    void add_to(std::vector<CausticEdge>& edges) {
        for (const Beam& beam : set_.beams)
            for (std::size_t i = 0; i < beam.triangle_count(); ++i)
                add_triangle(beam, set_.triangle(beam, i));
        for (const auto& [ends, kind] : kinds_)
            edges.push_back(
                {arrivals_.at(ends.first)->position, arrivals_.at(ends.second)->position, kind});
    }

private:
    void add_triangle(const Beam& beam, const std::array<const VertexRay*, 3>& rays) {
        const Vec3 normal =
            triangle_normal(rays[0]->position, rays[1]->position, rays[2]->position);
        std::array<const Arrival*, 3> at;
        for (std::size_t i = 0; i < 3; ++i) {
            at[i] = arrival(*rays[i], {rays[i]->position, normal, beam.offset});
            if (at[i] == nullptr || at[i]->shape != at[0]->shape) return;
        }
        const Vec3 u = at[1]->position - at[0]->position;
        const Vec3 v = at[2]->position - at[0]->position;
        const bool turned = u.cross(v).dot(rays[0]->direction) > 0;
        const auto kind =
            turned == starts_turned(beam) ? CausticEdge::Kind::direct : CausticEdge::Kind::folded;
        for (std::size_t i = 0; i < 3; ++i) {
            const RayBits a = bits(*rays[i]);
            const RayBits b = bits(*rays[(i + 1) % 3]);
            const auto [found, is_new] = kinds_.try_emplace(std::minmax(a, b), kind);
            if (!is_new && found->second != kind) found->second = CausticEdge::Kind::fold;
        }
    }

    // Where the ray meets a receiver, if it meets one first.
    const Arrival* arrival(const VertexRay& ray, const SegmentEnd& start) {
        const auto [found, is_new] = arrivals_.try_emplace(bits(ray));
        if (is_new) {
            const auto hit = scene_.intersect(spawn_ray(start, ray.direction));
            if (hit && is_receiver(scene_.shape_at(*hit).bsdf))
                found->second = {hit->position, hit->shape};
        }
        return found->second ? &*found->second : nullptr;
    }

    // How the polygon is wound, seen along its light: as the first surface's triangle along the
    // lamp's light, and every reflection turns it over.
    bool starts_turned(const Beam& beam) const {
        const auto& [i, j, k] = first_.triangles[beam.triangle];
        const Vec3& a = first_.positions[i];
        const Vec3 normal = triangle_normal(a, first_.positions[j], first_.positions[k]);
        return (normal.dot(to_light(set_.light, a)) < 0) != mirrored_;
    }

    const Scene& scene_;
    const TriangleMesh& first_;
    const BeamSet& set_;
    bool mirrored_ = false;  ///< by an odd number of reflections
    std::map<RayBits, std::optional<Arrival>> arrivals_;
    std::map<std::pair<RayBits, RayBits>, CausticEdge::Kind> kinds_;
};

}  // namespace

std::vector<CausticEdge> caustic_edges(const Scene& scene, const TracedScene& traced) {
    std::vector<CausticEdge> edges;
    for (const BeamSet& set : traced.sets)
        EdgeCollector(scene, traced.caster(set.caster).mesh, set).add_to(edges);
    return edges;
}

}  // namespace caustics::beamtree
