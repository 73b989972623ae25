#include "experiments/run/wide_triangles.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace caustics::experiments {

namespace {

std::vector<Vec3> places_of_lights(const Scene& scene) {
    std::vector<Vec3> places;
    for (const Light& light : scene.lights())
        if (const auto* const area = std::get_if<AreaLight>(&light))
            places.push_back(bounding_sphere(scene.shapes()[area->shape]).centre);
        else if (const auto point = point_of(light); point && point->position)
            places.push_back(*point->position);
    return places;
}

// What a triangle is to a light; no solid angle where it is turned away.
struct Seen {
    double angle = 0;
    double solid_angle = 0;
};

Seen seen(const Vec3& from, const std::array<Vec3, 3>& corners) {
    std::array<Vec3d, 3> to;
    for (std::size_t i = 0; i < 3; ++i) to[i] = (corners[i] - from).cast<double>().normalized();
    // Of the plane pyramid of the three directions (van Oosterom and Strackee 1983).
    const double volume = -to[0].dot(to[1].cross(to[2]));
    const double below = 1 + to[0].dot(to[1]) + to[1].dot(to[2]) + to[2].dot(to[0]);
    const double cosine = std::min({to[0].dot(to[1]), to[1].dot(to[2]), to[2].dot(to[0])});
    return {std::acos(std::clamp(cosine, -1.0, 1.0)), std::max(0.0, 2 * std::atan2(volume, below))};
}

bool is_flat(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& corners) {
    constexpr float same = 1e-3F;  // as beams take normals for one
    if (mesh.normals.empty()) return true;
    const auto& [a, b, c] = corners;
    return (mesh.normals[a] - mesh.normals[b]).norm() < same &&
           (mesh.normals[a] - mesh.normals[c]).norm() < same;
}

double mean_angle(const TriangleMesh& mesh, Triangles which, const Vec3& from) {
    constexpr std::size_t most = 100'000;
    const std::size_t stride = 1 + mesh.triangles.size() / most;
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); i += stride) {
        if (which == Triangles::of_changing_normals && is_flat(mesh, mesh.triangles[i])) continue;
        const auto& [a, b, c] = mesh.triangles[i];
        const Seen one = seen(from, {mesh.positions[a], mesh.positions[b], mesh.positions[c]});
        sum += one.angle * one.solid_angle;
        all += one.solid_angle;
    }
    return all > 0 ? sum / all : 0;
}

}  // namespace

std::optional<WideTriangles> wide_triangles(const Scene& scene, Triangles which, double least) {
    const std::vector<Vec3> places = places_of_lights(scene);
    std::optional<WideTriangles> widest;
    for (const Shape& shape : scene.shapes()) {
        if (shape.primitive != Primitive::mesh ||
            !std::holds_alternative<Dielectric>(shape.bsdf.model))
            continue;
        for (const Vec3& from : places)
            if (const double angle = mean_angle(shape.mesh, which, from);
                angle > (widest ? widest->angle : least))
                widest = WideTriangles{shape.name, angle};
    }
    return widest;
}

}  // namespace caustics::experiments
