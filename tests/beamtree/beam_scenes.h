#pragma once

#include <array>
#include <string>
#include <vector>

#include "beamtree/tracing/beam_tracing.h"
#include "core/geometry/tessellate.h"
#include "core/math/rng.h"
#include "tests/support/build_scene.h"

namespace caustics::beamtree {

/// Beams of a small scene, every caster a mesh.
struct BeamScene {
    std::string name;
    Scene scene;
    std::vector<CasterMesh> casters;
    std::vector<BeamSet> sets;

    BeamScene(const std::string& scene_name, SceneDesc desc,
              PolygonKind kind = PolygonKind::triangle, int light_samples = 4)
        : name(scene_name), scene(std::move(desc)), casters(caster_meshes(scene, 16, kind)) {
        sets = trace_all_beams(scene, casters, sample_lights(scene, light_samples, 1), {});
    }
};

inline SineHeightfield waves(double half = 1) {
    SineHeightfield field;
    field.half_size = Vec2d::Constant(half);
    field.waves = {{0.024, {7.1, 2.3}, 0.4}, {0.019, {-4.2, 8.6}, 1.9}, {0.011, {12.7, -6.1}, 3.1}};
    return field;
}

inline SceneDesc pool_desc(int resolution) {
    SceneDesc desc;
    desc.shapes = {support::mesh("water", tessellate_heightfield(waves(), resolution),
                                 Transform::Identity(), support::glass(1.333F)),
                   support::horizontal("floor", -1, 3, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0.4, 0.3, 2.5}, 10)};
    return desc;
}

/// Corners of a triangle that parallel light down a sine of 0.6 comes to.
inline const std::array<Vec3, 3> corners_in_light = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};

/// That light, and a lid over each of the first corners.
inline void add_light_and_lids(SceneDesc& desc, std::size_t lids) {
    for (std::size_t i = 0; i < lids; ++i) {
        const Vec3 above = corners_in_light[i] + Vec3(0.3F, 0, 0.4F);
        desc.shapes.push_back(support::sphere("lid" + std::to_string(i), above.cast<double>(), 0.1,
                                              support::diffuse(0.5F)));
    }
    desc.lights = {support::directional_light({-0.6, 0, -0.8}, 1)};
}

inline SceneDesc ring_desc(int resolution) {
    SceneDesc desc;
    const Transform size(Eigen::Scaling(0.5, 0.5, 0.25));
    desc.shapes = {support::mesh("ring", tessellate_cylinder(resolution), size, support::mirror()),
                   support::horizontal("floor", 0, 2, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0, 0.49, 0.4}, 1)};
    return desc;
}

inline SceneDesc ball_desc(int resolution) {
    SceneDesc desc;
    const Transform place(Eigen::Translation3d(0, 0, 0.6) * Eigen::Scaling(0.5));
    desc.shapes = {support::mesh("ball", tessellate_sphere(resolution), place, support::mirror()),
                   support::horizontal("floor", 0, 4, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({1.5, 0.4, 1.6}, 5)};
    return desc;
}

/// Triangles thrown about, with normals that have little to do with them.
inline SceneDesc soup_desc(int count) {
    TriangleMesh mesh;
    Rng rng(5, Stage::test, 0);
    const auto random = [&rng] { return Vec3(rng.next(), rng.next(), rng.next()); };
    for (int i = 0; i < count; ++i) {
        const Vec3 middle = random();
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int corner = 0; corner < 3; ++corner)
            mesh.positions.push_back(middle + 0.3F * (random() - Vec3::Constant(0.5F)));
        const Vec3 normal = (mesh.positions[first + 1] - mesh.positions[first])
                                .cross(mesh.positions[first + 2] - mesh.positions[first])
                                .normalized();
        for (int corner = 0; corner < 3; ++corner)
            mesh.normals.push_back(
                Vec3(normal + 0.8F * (random() - Vec3::Constant(0.5F))).normalized());
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    SceneDesc desc;
    desc.shapes = {support::mesh("soup", mesh, Transform::Identity(), support::glass(1.5F))};
    desc.lights = {support::point_light({0.5, 0.5, 4}, 5)};
    return desc;
}

}  // namespace caustics::beamtree
