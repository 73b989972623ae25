#include "tests/bench/tracing_scenes.h"

#include "core/geometry/tessellate.h"
#include "tests/support/build_scene.h"

namespace caustics::bench {

namespace {

Shape floor_mesh(double z, double half) {
    Transform to_world = Transform::Identity();
    to_world.translate(Vec3d(0, 0, z));
    to_world.scale(Vec3d(half, half, 1));
    return support::mesh("floor", tessellate_rectangle(1), to_world, support::diffuse(0.5F));
}

}  // namespace

SceneDesc pool_scene(int resolution) { return pool_scene(resolution, 1); }

SceneDesc pool_scene(int resolution, double waves) {
    SineHeightfield field;
    field.waves = {{0.024, {7.1, 2.3}, 0.4},
                   {0.019, {-4.2, 8.6}, 1.9},
                   {0.011, {12.7, -6.1}, 3.1},
                   {0.006, {5.3, 17.9}, 5.2}};
    for (SineWave& wave : field.waves) wave.amplitude *= waves;
    field.half_size = {1, 1};
    SceneDesc desc;
    desc.shapes = {support::mesh("water", tessellate_heightfield(field, resolution),
                                 Transform::Identity(), support::glass(1.333F)),
                   floor_mesh(-1, 4)};
    desc.lights = {support::point_light({0.4, 0.3, 2.5}, 10)};
    return desc;
}

SceneDesc ball_scene(int resolution) {
    SceneDesc desc;
    desc.shapes = {support::mesh("ball", tessellate_sphere(resolution), Transform::Identity(),
                                 support::glass(1.5F)),
                   floor_mesh(-1.2, 8)};
    desc.lights = {support::point_light({-3, 1, 4}, 10)};
    return desc;
}

}  // namespace caustics::bench
