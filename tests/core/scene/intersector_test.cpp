#include "core/scene/intersector.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/geometry/exact_shape.h"
#include "core/geometry/tessellate.h"
#include "core/math/rng.h"
#include "core/math/sampling.h"
#include "tests/support/build_scene.h"
#include "tests/support/random_direction.h"

namespace caustics {
namespace {

using support::random_direction;

Scene scene_of(std::vector<Shape> shapes) {
    SceneDesc desc;
    desc.shapes = std::move(shapes);
    return Scene(std::move(desc));
}

Shape exact(Primitive primitive, const Transform& to_world) {
    Shape shape;
    shape.primitive = primitive;
    shape.to_world = to_world;
    return shape;
}

Shape water(const Transform& to_world) {
    Shape shape = exact(Primitive::heightfield, to_world);
    shape.field.waves = {{0.1, {5, 1}, 0.3}, {0.05, {-3, 9}, 1}};
    return shape;
}

Transform turned() {
    return Eigen::Translation3d(0.3, -0.2, 0.1) *
           Eigen::AngleAxisd(0.7, Vec3d(1, 2, -1).normalized()) * Transform::Identity();
}

Vec3 random_point(Rng& rng, float half) {
    const float x = rng.next(), y = rng.next(), z = rng.next();
    return half * (2 * Vec3(x, y, z) - Vec3::Ones());
}

// Squares of their areas are no floats.
TEST(Intersector, HasUnitNormalsOnTrianglesOfAnySize) {
    for (const double size : {0x1p-33, 0x1p-20, 1.0, 0x1p30, 0x1p38})
        for (const bool smooth : {false, true}) {
            Shape shape;
            shape.primitive = Primitive::mesh;
            shape.mesh = tessellate_cube(16);
            if (!smooth) shape.mesh.normals.clear();
            transform(shape.mesh, Transform(Eigen::Scaling(size)));
            const AreaSampler lamp(shape);
            EXPECT_NEAR(lamp.sample(shape, 0.3F, 0.4F).normal.norm(), 1, 1e-6) << size;
            const Scene scene = scene_of({shape});
            const auto width = static_cast<float>(size);
            const auto hit =
                scene.intersect({width * Vec3(0.3F, 0.1F, 4), Vec3(0.01F, 0, -1).normalized()});
            ASSERT_TRUE(hit) << size;
            EXPECT_LT((hit->geometric_normal - Vec3::UnitZ()).norm(), 1e-5F) << size;
            EXPECT_LT((hit->shading_normal - Vec3::UnitZ()).norm(), 1e-5F) << size;
        }
}

// World-frame hits against the local solver, by every transform that scene files can make.
TEST(Intersector, SeesExactShapesThroughTheirTransforms) {
    Rng rng(1, Stage::test, 0);
    for (const Primitive primitive : {Primitive::rectangle, Primitive::disk, Primitive::sphere,
                                      Primitive::cylinder, Primitive::heightfield})
        for (const bool flip : {false, true}) {
            const bool flat = primitive != Primitive::sphere && primitive != Primitive::cylinder;
            const Vec3d scale = flat ? Vec3d(0.5, 2, 1.5) : Vec3d::Constant(0.7);
            const Transform to_world = turned() * Eigen::Scaling(scale);
            Shape shape =
                primitive == Primitive::heightfield ? water(to_world) : exact(primitive, to_world);
            shape.flip_normals = flip;
            const Scene scene = scene_of({shape});
            int hits = 0;
            for (int i = 0; i < 2000; ++i) {
                const Vec3 o = random_point(rng, 4);
                const Vec3 d = (random_point(rng, 1) - o).normalized();
                const Transform inverse = to_world.inverse();
                const Vec3d local_d = inverse.linear() * d.cast<double>();
                const auto local =
                    intersect_exact(shape, inverse * o.cast<double>(), local_d, 0, 1e9);
                const auto hit = scene.intersect({o, d});
                ASSERT_EQ(hit.has_value(), local.has_value());
                if (!hit) continue;
                ++hits;
                EXPECT_NEAR(static_cast<double>(hit->distance), local->distance, 1e-5);
                EXPECT_LT((hit->position - (o + hit->distance * d)).norm(), 1e-5F);
                const Vec3d n = to_world.linear().inverse().transpose() *
                                exact_normal(shape, local->local) * (flip ? -1 : 1);
                EXPECT_LT((hit->geometric_normal - n.normalized().cast<float>()).norm(), 1e-5F);
                EXPECT_EQ(hit->uv, exact_uv(shape, local->local));
                EXPECT_TRUE(scene.occluded_along({o}, d));
            }
            EXPECT_GT(hits, 100);
        }
}

TEST(Intersector, AnExactHeightfieldIsTheLimitOfItsMeshes) {
    const Shape field = water(turned());
    const Scene exact_scene = scene_of({field});
    const Scene mesh_scene =
        scene_of({support::mesh("water", tessellate_heightfield(field.field, 256), turned(), {})});
    Rng rng(2, Stage::test, 0);
    int compared = 0;
    for (int i = 0; i < 5000; ++i) {
        const Vec3 o = random_point(rng, 3);
        const Vec3 d = (random_point(rng, 0.6F) - o).normalized();
        const auto hit = exact_scene.intersect({o, d});
        // Silhouettes may fall on either side.
        if (!hit || std::abs(hit->geometric_normal.dot(d)) < 0.3F) continue;
        const auto near = mesh_scene.intersect({o, d});
        if (!near) continue;
        ++compared;
        if (std::abs(near->distance - hit->distance) > 0.01F) continue;  // a crest hides it
        EXPECT_NEAR(near->distance, hit->distance, 2e-4F);
        EXPECT_GT(near->shading_normal.dot(hit->shading_normal), 0.9999F);
    }
    EXPECT_GT(compared, 500);
}

// Bundles of rays from one place towards meshes and exact shapes that overlap, more or less parallel,
// of every size a packet may have.
TEST(Intersector, RaysThatGoTogetherHitWhatTheyHitAlone) {
    const Scene scene = scene_of(
        {water(turned()), exact(Primitive::sphere, Eigen::Translation3d(0, 0, 1) * turned()),
         support::mesh("torus", tessellate_heightfield(water(turned()).field, 64),
                       Eigen::Translation3d(0.2, 0.1, 0.2) * turned(), {}),
         exact(Primitive::rectangle, Eigen::Translation3d(0, 0, -1) * Eigen::Scaling(5.0))});
    Rng rng(9, Stage::test, 0);
    std::array<Ray, Scene::most_together> rays;
    std::array<std::optional<SurfacePoint>, Scene::most_together> together;
    std::array<int, 4> hits{};
    int misses = 0, elsewhere = 0;
    for (int bundle = 0; bundle < 3000; ++bundle) {
        const std::size_t count = 1 + static_cast<std::size_t>(bundle) % rays.size();
        const Vec3 o = random_point(rng, 3);
        const Vec3 towards = (random_point(rng, 1) - o).normalized();
        const float spread = rng.next() < 0.2F ? 2 : 0.05F;
        for (std::size_t i = 0; i < count; ++i)
            rays[i] = {o, (towards + random_point(rng, spread)).normalized(),
                       rng.next() < 0.1F ? 2.5F : Ray().max_distance};
        scene.intersect_together(std::span(rays).first(count), together);
        for (std::size_t i = 0; i < count; ++i) {
            const auto alone = scene.intersect(rays[i]);
            if (!alone || !together[i] || alone->shape != together[i]->shape) {
                ++(alone || together[i] ? elsewhere : misses);
                continue;
            }
            ++hits[alone->shape];
            EXPECT_LT((alone->position - together[i]->position).norm(), 1e-5F);
            EXPECT_NEAR(alone->distance, together[i]->distance, 1e-5F);
            EXPECT_EQ(alone->offset, together[i]->offset);
            if (scene.shape_at(*alone).primitive == Primitive::mesh) continue;
            EXPECT_EQ(alone->position, together[i]->position);
            EXPECT_EQ(alone->geometric_normal, together[i]->geometric_normal);
            EXPECT_EQ(alone->uv, together[i]->uv);
        }
    }
    for (const int of_shape : hits) EXPECT_GT(of_shape, 1000);
    EXPECT_GT(misses, 1000);
    EXPECT_LE(elsewhere, 2);  // rounding at an edge
}

/// Leaves minus ones where the variables of the next function will lie.
[[gnu::noinline]] void soil_the_stack() {
    std::array<volatile float, 4096> left;
    for (volatile float& value : left) value = -1;
}

// What lay in the place of the rays that it lacks is none of them; Embree aborted there.
TEST(Intersector, APacketNeedNotBeFull) {
    const Scene scene = scene_of({exact(Primitive::rectangle, Transform::Identity())});
    std::array<Ray, Scene::most_together> rays;
    rays.fill({Vec3(0.1F, 0.2F, 2), -Vec3::UnitZ()});
    std::array<std::optional<SurfacePoint>, Scene::most_together> hits;
    for (std::size_t count = 1; count <= rays.size(); ++count) {
        soil_the_stack();
        scene.intersect_together(std::span(rays).first(count), hits);
        for (std::size_t i = 0; i < count; ++i) {
            ASSERT_TRUE(hits[i]);
            EXPECT_EQ(hits[i]->distance, 2);
        }
    }
}

struct Placement {
    double scale;
    Vec3d centre;
};

std::vector<Placement> placements() {
    return {{1, Vec3d::Zero()},        {1e-3, Vec3d::Zero()},  {1e3, Vec3d::Zero()},
            {1, Vec3d(100, -200, 50)}, {1e-2, Vec3d(1, 2, 3)}, {10, Vec3d(-5000, 0, 3000)}};
}

std::vector<Shape> closed_or_open_shapes(const Placement& at) {
    const Transform to_world = Eigen::Translation3d(at.centre) *
                               Eigen::AngleAxisd(0.7, Vec3d(1, 2, -1).normalized()) *
                               Eigen::Scaling(at.scale);
    return {exact(Primitive::sphere, to_world),
            exact(Primitive::cylinder, to_world),
            exact(Primitive::rectangle, to_world),
            exact(Primitive::disk, to_world),
            water(to_world),
            support::mesh("ball", tessellate_sphere(20), to_world, {}),
            support::mesh("cube", tessellate_cube(2), to_world, {})};
}

// A ray that leaves a surface to the side it was sent to does not meet the same place again: what
// it meets, if anything, is away from it by more than offsets explain.
TEST(Intersector, SpawnedRaysNeitherHitTheirOwnSurfaceNorLeakThroughIt) {
    for (const Placement& at : placements())
        for (const Shape& shape : closed_or_open_shapes(at)) {
            const bool flat =
                shape.primitive == Primitive::rectangle || shape.primitive == Primitive::disk;
            const bool convex = flat || shape.primitive == Primitive::sphere ||
                                shape.primitive == Primitive::cylinder ||
                                shape.primitive == Primitive::mesh;
            const bool closed =
                shape.primitive == Primitive::sphere || shape.primitive == Primitive::mesh;
            const Scene scene = scene_of({shape});
            const Vec3 centre = at.centre.cast<float>();
            const auto size = static_cast<float>(at.scale);
            Rng rng(3, Stage::test, 0);
            int outwards_hits = 0, inwards_misses = 0, tried = 0;
            for (int i = 0; i < 2000; ++i) {
                const Vec3 o = centre + random_point(rng, 3 * size);
                const auto hit = scene.intersect(
                    {o, (centre + random_point(rng, 0.5F * size) - o).normalized()});
                if (!hit) continue;
                ++tried;
                const Vec3 n = hit->geometric_normal;
                Vec3 w = random_direction(rng);
                if (std::abs(n.dot(w)) < 1e-3F) continue;
                if (n.dot(w) < 0) w = -w;
                const SegmentEnd end{hit->position, n, hit->offset};
                // Outside a convex shape there is nothing more to meet.
                if (convex && scene.intersect(spawn_ray(end, w))) ++outwards_hits;
                // Into a closed shape there is always the far side.
                const auto far = scene.intersect(spawn_ray(end, -w));
                if (closed && n.dot(w) > 0.05F && !far) ++inwards_misses;
                if (flat && far) ++outwards_hits;
            }
            const auto kind = static_cast<int>(shape.primitive);
            EXPECT_GT(tried, 200) << kind;
            EXPECT_EQ(outwards_hits, 0)
                << "shape " << kind << " scale " << at.scale << " of " << tried;
            EXPECT_EQ(inwards_misses, 0) << "shape " << kind << " scale " << at.scale;
        }
}

TEST(Intersector, RaysFromInsideAClosedShapeAlwaysHit) {
    Rng rng(4, Stage::test, 0);
    for (const Placement& at : placements())
        for (const Shape& shape : closed_or_open_shapes(at)) {
            if (shape.primitive != Primitive::sphere && shape.primitive != Primitive::mesh)
                continue;
            const Scene scene = scene_of({shape});
            for (int i = 0; i < 3000; ++i) {
                const Vec3 o = at.centre.cast<float>() +
                               random_point(rng, 0.5F * static_cast<float>(at.scale));
                const Vec3 d = random_direction(rng);
                const auto hit = scene.intersect({o, d});
                ASSERT_TRUE(hit) << at.scale;
                EXPECT_GT(hit->geometric_normal.dot(d), 0);
            }
        }
}

// Rays aimed exactly at shared edges and vertices of a closed mesh.
TEST(Intersector, MeshesAreWatertightAlongTheirEdges) {
    const Shape ball = support::mesh("ball", tessellate_sphere(12), turned(), {});
    const Scene scene = scene_of({ball});
    const Vec3 inside = Vec3d(turned().translation()).cast<float>();
    for (const auto& [a, b, c] : ball.mesh.triangles)
        for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}})
            for (const float share : {0.0F, 0.25F, 0.5F, 0.9F}) {
                const Vec3 at =
                    (1 - share) * ball.mesh.positions[p] + share * ball.mesh.positions[q];
                const Vec3 d = (at - inside).normalized();
                ASSERT_TRUE(scene.intersect({inside, d}));
                ASSERT_TRUE(scene.intersect({inside + 5 * d, -d}));
            }
}

TEST(Intersector, OcclusionAgreesWithIntersection) {
    std::vector<Shape> shapes;
    Rng rng(5, Stage::test, 0);
    for (int i = 0; i < 20; ++i) {
        const Transform to_world = Eigen::Translation3d(random_point(rng, 3).cast<double>()) *
                                   Eigen::AngleAxisd(i, Vec3d(1, 2, -1).normalized()) *
                                   Eigen::Scaling(0.4);
        const auto at = static_cast<std::size_t>(i);
        shapes.push_back(closed_or_open_shapes({1, Vec3d::Zero()})[at % 7]);
        if (shapes.back().primitive == Primitive::mesh)
            transform(shapes.back().mesh, to_world);
        else
            shapes.back().to_world = to_world;
    }
    const Scene scene = scene_of(std::move(shapes));
    int blocked = 0;
    for (int i = 0; i < 20'000; ++i) {
        const Vec3 a = random_point(rng, 4), b = random_point(rng, 4);
        const Vec3 d = (b - a).normalized();
        const float length = (b - a).norm();
        const auto hit = scene.intersect({a, d});
        ASSERT_EQ(scene.occluded_along({a}, d), hit.has_value());
        if (hit && std::abs(hit->distance - length) < 1e-4F) continue;
        const bool between = hit && hit->distance < length;
        ASSERT_EQ(scene.occluded({a}, SegmentEnd{b}), between);
        ASSERT_EQ(scene.intersect({a, d, length}).has_value(), between);
        blocked += between ? 1 : 0;
    }
    EXPECT_GT(blocked, 1000);
}

}  // namespace
}  // namespace caustics
