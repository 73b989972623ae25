#include "beamtree/light/beam_point.h"
#include "beamtree/light/projected.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

int winding_of(const BeamSet& set, const TestPlane& plane) {
    std::array<BeamHit, 2> hits;
    int sum = 0;
    for (const Beam& beam : set.beams) {
        const int count = test_beam(set, beam, plane, hits);
        for (int i = 0; i < count; ++i) sum += hits[static_cast<std::size_t>(i)].winding;
    }
    return sum;
}

// Parallel light straight down through a still surface: the caustic polygons are the mesh itself.
BeamScene still_water(int resolution, PolygonKind kind) {
    SceneDesc desc;
    desc.shapes = {support::mesh("water", tessellate_rectangle(resolution), Transform::Identity(),
                                 support::glass(1.25F))};
    desc.lights = {support::directional_light({0, 0, -1}, 1)};
    return {"still water", std::move(desc), kind};
}

const BeamSet& refracted(const BeamScene& scene) {
    for (const BeamSet& set : scene.sets)
        if (set.refracted) return set;
    throw std::logic_error("nothing is refracted");
}

// Vertices, edges and diagonals of a dyadic grid are exact in float: every such point inside the
// rectangle belongs to one triangle, and those of its upper and right edge to none.
TEST(BeamPoint, EveryPointOfAFlatGridLiesInOneBeam) {
    for (const PolygonKind kind : {PolygonKind::triangle, PolygonKind::quad}) {
        const BeamScene water = still_water(16, kind);
        const BeamSet& set = refracted(water);
        EXPECT_EQ(set.beams.size(), kind == PolygonKind::quad ? 256U : 512U);
        for (int i = 1; i < 64; ++i)
            for (int j = 1; j < 64; ++j) {
                const Vec3 p(static_cast<float>(i - 32) / 32, static_cast<float>(j - 32) / 32, -1);
                std::array<BeamHit, 2> hits;
                int found = 0;
                for (const Beam& beam : set.beams)
                    found += test_beam(set, beam, TestPlane(p, Vec3::UnitZ()), hits);
                EXPECT_EQ(found, 1) << p.transpose();
            }
    }
}

/// The directed edges that belong to one triangle only.
std::vector<std::array<std::uint32_t, 2>> boundary(const BeamSet& set) {
    std::map<std::array<std::uint32_t, 2>, int> edges;
    for (const Beam& beam : set.beams)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = beam.corners[i];
            const std::uint32_t b = beam.corners[(i + 1) % 3];
            if (const auto back = edges.find({b, a}); back != edges.end())
                edges.erase(back);
            else
                edges[{a, b}] = 1;
        }
    std::vector<std::array<std::uint32_t, 2>> rest;
    for (const auto& [edge, count] : edges) rest.push_back(edge);
    return rest;
}

// Whatever the folds and the rounding: points at random, on the caustic polygons' corners, on the
// middles of their edges; planes level and tilted.
TEST(BeamPoint, WindingsSumToTheBoundarysWinding) {
    const BeamScene pool("pool", pool_desc(24));
    const BeamSet& set = refracted(pool);
    const auto edges = boundary(set);
    Rng rng(3, Stage::test, 0);
    const auto on = [](const TestPlane& plane, const VertexRay& ray) {
        return plane.project(ray.position,
                             plane.height(ray.position) / plane.steepness(ray.direction),
                             ray.direction);
    };
    int wrong = 0;
    int folded = 0;
    for (int i = 0; i < 6000; ++i) {
        const Beam& beam = set.beams[rng.next_word() % set.beams.size()];
        const auto rays = set.triangle(beam, 0);
        const float depth = 1 + rng.next();
        Vec3 p(2 * rng.next() - 1, 2 * rng.next() - 1, -depth);
        const auto hit = [depth](const VertexRay& ray) -> Vec3 {
            const float s = (ray.position.z() + depth) / -ray.direction.z();
            return ray.position + s * ray.direction;
        };
        if (i % 3 == 1) p = hit(*rays[0]);
        if (i % 3 == 2) p = (hit(*rays[0]) + hit(*rays[1])) / 2;
        const Vec3 tilted = Vec3(0.3F * rng.next(), 0.2F * rng.next(), 1).normalized();
        const TestPlane plane(p, i % 2 == 0 ? Vec3(Vec3::UnitZ()) : tilted);
        int around = 0;
        for (const auto& [a, b] : edges)
            around += edge_crossing(on(plane, set.rays[a]), on(plane, set.rays[b]));
        const int sum = winding_of(set, plane);
        wrong += sum != around;
        std::array<BeamHit, 2> hits;
        int covering = 0;
        for (const Beam& one : set.beams) covering += test_beam(set, one, plane, hits);
        folded += covering > 1;
        EXPECT_GE(covering, std::abs(sum));
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(folded, 100);
}

BeamSet three_rays(const std::array<VertexRay, 3>& rays) {
    BeamSet set;
    set.rays.assign(rays.begin(), rays.end());
    Beam beam;
    beam.corners = {0, 1, 2, Beam::none};
    beam.flux = Spectrum::Ones();
    set.beams = {beam};
    return set;
}

TEST(BeamPoint, TellsAreaWindingAndPlaceByHand) {
    // Rays that cross at height 1: below, the triangle is turned round, and at 0 as large as at 2.
    const Vec3 focus(0, 0, 1);
    std::array<VertexRay, 3> rays;
    const std::array<Vec3, 3> corners = {Vec3(0, 0, 2), Vec3(1, 0, 2), Vec3(0, 1, 2)};
    for (std::size_t i = 0; i < 3; ++i)
        rays[i] = {corners[i], Vec3(focus - corners[i]).normalized()};
    const BeamSet set = three_rays(rays);
    std::array<BeamHit, 2> hits;
    ASSERT_EQ(test_beam(set, set.beams[0], TestPlane({-0.25F, -0.5F, 0}, Vec3::UnitZ()), hits), 1);
    EXPECT_NEAR(hits[0].area, 0.5, 1e-6);
    EXPECT_NEAR(hits[0].weights[0], 0.25, 1e-6);
    EXPECT_NEAR(hits[0].weights[1], 0.25, 1e-6);
    EXPECT_NEAR(hits[0].weights[2], 0.5, 1e-6);
    const int below = hits[0].winding;
    ASSERT_EQ(test_beam(set, set.beams[0], TestPlane({0.1F, 0.1F, 1.5F}, Vec3::UnitZ()), hits), 1);
    EXPECT_NEAR(hits[0].area, 0.125, 1e-6);
    EXPECT_EQ(hits[0].winding, below);  // a point reflection turns the plane by 180 degrees
    EXPECT_EQ(test_beam(set, set.beams[0], TestPlane({0.25F, 0.5F, 0}, Vec3::UnitZ()), hits), 0);
    // From below, and behind the polygon.
    EXPECT_EQ(test_beam(set, set.beams[0], TestPlane({-0.25F, -0.5F, 0}, -Vec3::UnitZ()), hits), 0);
    EXPECT_EQ(test_beam(set, set.beams[0], TestPlane({0.1F, 0.1F, 3}, Vec3::UnitZ()), hits), 0);
}

// A plane that cuts the polygon in half lets the light of the upper half through.
TEST(BeamPoint, IsClippedAtTheReceiversPlane) {
    const Vec3 down = Vec3(0, -0.6F, -0.8F);
    const BeamSet set =
        three_rays({VertexRay{{0, 0, -1}, down}, {{1, 0, 1}, down}, {{-1, 0, 1}, down}});
    std::array<BeamHit, 2> hits;
    const TestPlane floor({0, -0.3F, 0}, Vec3::UnitZ());
    ASSERT_EQ(test_beam(set, set.beams[0], floor, hits), 1);
    // Three quarters of the polygon's area are above the plane; its shadow is a trapezium with sides
    // 1 and 2 and height 0.75.
    EXPECT_NEAR(hits[0].flux_share, 0.75, 1e-6);
    EXPECT_NEAR(hits[0].area, 1.125, 1e-6);
    EXPECT_NEAR(hits[0].weights.sum(), 1, 1e-6);
    EXPECT_EQ(test_beam(set, set.beams[0], TestPlane({0, 0.1F, 0}, Vec3::UnitZ()), hits), 0);
    EXPECT_EQ(test_beam(set, set.beams[0], TestPlane({0, -0.8F, 0}, Vec3::UnitZ()), hits), 0);
}

// Of this triangle one corner is below the plane and the rays of another rise: what is left has a
// corner inside, where rays are both at the plane and along it.
TEST(BeamPoint, IsClippedByBothLimitsAtOnce) {
    const auto ray = [](const Vec3& p, float steepness) {
        return VertexRay{p, Vec3(std::sqrt(1 - steepness * steepness), 0, -steepness)};
    };
    const BeamSet set =
        three_rays({ray({0, 0, 1}, 0.5F), ray({1, 0, 1}, -0.2F), ray({0, 1, -1}, 0.4F)});
    const auto point_of = [&](const Vec3& l, auto member) {
        return Vec3(l[0] * (set.rays[0].*member) + l[1] * (set.rays[1].*member) +
                    l[2] * (set.rays[2].*member));
    };
    const Vec3 inside(0.6F, 0.2F, 0.2F);
    const auto foot = [&](const Vec3& l) {
        const Vec3 p = point_of(l, &VertexRay::position);
        const Vec3 d = point_of(l, &VertexRay::direction);
        return Vec3(p + p.z() / -d.z() * d);
    };
    std::array<BeamHit, 2> hits;
    ASSERT_EQ(test_beam(set, set.beams[0], TestPlane(foot(inside), Vec3::UnitZ()), hits), 1);
    // Flux for an area: the triangle of weights, half a unit, is spread by the ray's foot. What the
    // whole caustic polygon has, which reaches to the horizon, is next to nothing.
    const Vec3 u = (foot({0.61F, 0.19F, 0.2F}) - foot({0.59F, 0.21F, 0.2F})) / 0.02F;
    const Vec3 v = (foot({0.61F, 0.2F, 0.19F}) - foot({0.59F, 0.2F, 0.21F})) / 0.02F;
    const double density = 2 / static_cast<double>(u.cross(v).norm());
    EXPECT_NEAR(hits[0].flux_share / hits[0].area / density, 1, 0.1);
}

// Four corners are one caustic polygon while they do not fold over.
TEST(BeamPoint, TakesFourCorners) {
    BeamSet set;
    for (const Vec3& p : {Vec3(0, 0, 1), Vec3(2, 0, 1), Vec3(2, 1, 1), Vec3(0, 1, 1)})
        set.rays.push_back({p, -Vec3::UnitZ()});
    Beam beam;
    beam.corners = {0, 1, 2, 3};
    beam.first_share = 0.5F;
    set.beams = {beam};
    std::array<BeamHit, 2> hits;
    for (const Vec3& p : {Vec3(1.5F, 0.2F, 0), Vec3(0.5F, 0.8F, 0), Vec3(1, 0.5F, 0)}) {
        ASSERT_EQ(test_beam(set, beam, TestPlane(p, Vec3::UnitZ()), hits), 1);
        EXPECT_NEAR(hits[0].area, 2, 1e-9);
        EXPECT_EQ(hits[0].flux_share, 1);
    }
    EXPECT_EQ(test_beam(set, beam, TestPlane({2.5F, 0.5F, 0}, Vec3::UnitZ()), hits), 0);
    // Folded along its diagonal: each triangle has its own half of the flux.
    set.rays[3].position = Vec3(2.5F, 0.25F, 1);
    ASSERT_GE(test_beam(set, beam, TestPlane({1.5F, 0.2F, 0}, Vec3::UnitZ()), hits), 1);
    EXPECT_EQ(hits[0].flux_share, 0.5);
}

/// Whether a ray of the triangle's inside that goes down from above z = 0 lands near a point there.
bool lands_near(const std::array<VertexRay, 3>& rays, const Vec2& point) {
    constexpr int steps = 400;
    for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j) {
            const Vec3 w = Vec3(static_cast<float>(i), static_cast<float>(j),
                                static_cast<float>(steps - i - j)) /
                           steps;
            Vec3 origin = Vec3::Zero();
            Vec3 direction = Vec3::Zero();
            for (int k = 0; k < 3; ++k) {
                origin += w[k] * rays[static_cast<std::size_t>(k)].position;
                direction += w[k] * rays[static_cast<std::size_t>(k)].direction;
            }
            if (origin.z() <= 0 || direction.z() >= 0) continue;
            const Vec3 landing = origin - origin.z() / direction.z() * direction;
            if ((landing.head<2>() - point).norm() < 0.02F) return true;
        }
    return false;
}

// One ray of three goes up and one begins below the plane: what is left of the triangle ends where
// rays along the plane begin on it, a corner of neither edge. (Points keep away from the way out along
// the first edge, which is curved and taken as straight.)
TEST(BeamPoint, TwoLimitsMeetInACornerOfTheirOwn) {
    const float half = std::sqrt(0.5F);
    const std::array<VertexRay, 3> rays = {VertexRay{Vec3(0, 0, 1), Vec3(0, 0, -1)},
                                           VertexRay{Vec3(1, 4, 1), Vec3(half, 0, half)},
                                           VertexRay{Vec3(0, 3, -2), Vec3(0, 0, -1)}};
    for (const auto& order : {std::array{0, 1, 2}, std::array{1, 2, 0}, std::array{0, 2, 1}}) {
        std::array<VertexRay, 3> turned;
        for (std::size_t i = 0; i < 3; ++i) turned[i] = rays[static_cast<std::size_t>(order[i])];
        const BeamSet set = three_rays(turned);
        std::array<BeamHit, 2> hits;
        for (const Vec2& at : {Vec2(0.5F, 2), Vec2(2, 2.5F), Vec2(0.2F, 1.2F), Vec2(0.15F, 2),
                               Vec2(0.5F, 3.5F), Vec2(1, -0.1F), Vec2(-0.1F, 0.5F)}) {
            const TestPlane plane({at.x(), at.y(), 0}, Vec3::UnitZ());
            EXPECT_EQ(test_beam(set, set.beams[0], plane, hits), lands_near(rays, at) ? 1 : 0)
                << at.transpose();
        }
    }
}

// At water's edge corners lie on the wall's plane, above or below it by rounding: one caustic polygon nonetheless.
TEST(BeamPoint, TakesFourCornersWhereSomeLieOnThePlane) {
    for (const float height : {1e-9F, 0.0F, -1e-9F}) {
        BeamSet set;
        for (const Vec3& p : {Vec3(0, 0, height), Vec3(3, 0, height), Vec3(2, 1, 1), Vec3(0, 1, 1)})
            set.rays.push_back({p, Vec3(0, 0.6F, -0.8F)});
        Beam beam;
        beam.corners = {0, 1, 2, 3};
        beam.first_share = 0.5F;
        set.beams = {beam};
        std::array<BeamHit, 2> hits;
        ASSERT_EQ(test_beam(set, beam, TestPlane({1, 0.5F, 0}, Vec3::UnitZ()), hits), 1) << height;
        EXPECT_NEAR(hits[0].area, 4.375, 1e-6) << height;
        EXPECT_NEAR(hits[0].flux_share, 1, 1e-6) << height;
    }
}

// Parallel light brings each point of a triangle straight down: where the light left, and how dense it is, are the same for
// what is left of a triangle that the plane cuts, whichever way.
TEST(BeamPoint, TellsWhereParallelLightLeftATriangleThatIsCut) {
    const Vec3 down(0, -0.6F, -0.8F);
    Rng rng(5, Stage::test, 0);
    const auto number = [&rng] { return 2 * rng.next() - 1; };
    std::array<int, 4> hits_by_corners_above = {};
    for (int i = 0; i < 5000; ++i) {
        std::array<VertexRay, 3> rays;
        std::size_t above = 0;
        for (VertexRay& ray : rays) {
            ray = {{number(), number(), number()}, down};
            above += ray.position.z() > 0;
        }
        const BeamSet set = three_rays(rays);
        const auto foot = [&](const Vec3& p) { return Vec3(p + p.z() / 0.8F * down); };
        const float u = rng.next(), v = rng.next() * (1 - u);
        const Vec3 from =
            (1 - u - v) * rays[0].position + u * rays[1].position + v * rays[2].position;
        std::array<BeamHit, 2> hits;
        const int count = test_beam(set, set.beams[0], TestPlane(foot(from), Vec3::UnitZ()), hits);
        if (std::abs(from.z()) < 1e-3F) continue;
        EXPECT_EQ(count, from.z() > 0 ? 1 : 0);
        if (count == 0) continue;
        Vec3 left = Vec3::Zero();
        for (std::size_t k = 0; k < 3; ++k)
            left += hits[0].weights[static_cast<Eigen::Index>(k)] * rays[k].position;
        const Vec3 side = foot(rays[1].position) - foot(rays[0].position);
        const Vec3 other = foot(rays[2].position) - foot(rays[0].position);
        const auto whole = static_cast<double>(side.cross(other).norm()) / 2;
        if (whole < 0.05) continue;
        ++hits_by_corners_above[above];
        EXPECT_LT((left - from).norm(), 1e-3F) << i;
        EXPECT_NEAR(hits[0].flux_share / hits[0].area * whole, 1, 1e-4) << i;
    }
    for (const std::size_t above : {1U, 2U, 3U}) EXPECT_GT(hits_by_corners_above[above], 300);
}

/// Three rays from places at any height, most of them down.
std::array<VertexRay, 3> wild_rays(Rng& rng) {
    std::array<VertexRay, 3> rays;
    for (VertexRay& ray : rays) {
        const Vec3 way(2 * rng.next() - 1, 2 * rng.next() - 1, 0.3F - 1.3F * rng.next());
        ray = {{2 * rng.next() - 1, 2 * rng.next() - 1, 1.2F * rng.next() - 0.2F},
               way.normalized()};
    }
    return rays;
}

TEST(BeamPoint, WeightsAreThoseOfAMean) {
    Rng rng(6, Stage::test, 0);
    int hits_of_all = 0;
    for (int i = 0; i < 100'000; ++i) {
        const BeamSet set = three_rays(wild_rays(rng));
        const Vec3 point(3 * rng.next() - 1.5F, 3 * rng.next() - 1.5F, 0);
        std::array<BeamHit, 2> hits;
        if (test_beam(set, set.beams[0], TestPlane(point, Vec3::UnitZ()), hits) == 0) continue;
        ++hits_of_all;
        EXPECT_GE(hits[0].weights.minCoeff(), 0) << i;
        EXPECT_NEAR(hits[0].weights.sum(), 1, 1e-5) << i;
    }
    EXPECT_GT(hits_of_all, 5000);
}

// Whichever corner of three has the light that comes down most steeply, or least. (Where the plane across the light cuts the
// triangle the corners of what is left are taken by turns.)
TEST(BeamPoint, DoesNotDependOnWhichCornerIsFirst) {
    Rng rng(7, Stage::test, 0);
    int hits_of_all = 0;
    int uneven = 0;
    for (int i = 0; i < 20'000; ++i) {
        std::array<VertexRay, 3> rays;
        std::vector<float> steepness;
        for (VertexRay& ray : rays) {
            const Vec3 way(rng.next(), rng.next() - 0.5F, -0.3F - rng.next());
            ray = {{2 * rng.next() - 1, 2 * rng.next() - 1, 0.2F * rng.next()}, way.normalized()};
            steepness.push_back(-ray.direction.z());
        }
        const TestPlane plane({2 * rng.next() - 0.5F, 2 * rng.next() - 1, -0.3F}, Vec3::UnitZ());
        std::array<double, 3> density = {};
        for (std::size_t first = 0; first < 3; ++first) {
            const BeamSet set = three_rays(rays);
            std::array<BeamHit, 2> hits;
            if (test_beam(set, set.beams[0], plane, hits) == 1)
                density[first] = hits[0].flux_share / hits[0].area;
            std::rotate(rays.begin(), rays.begin() + 1, rays.end());
        }
        EXPECT_NEAR(density[1], density[0], 0.1 * density[0]) << i;
        EXPECT_NEAR(density[2], density[0], 0.1 * density[0]) << i;
        hits_of_all += density[0] > 0;
        const auto [least, most] = std::ranges::minmax(steepness);
        uneven +=
            density[0] > 0 && static_cast<double>(most) > most_uneven * static_cast<double>(least);
    }
    EXPECT_GT(hits_of_all, 1000);
    EXPECT_GT(uneven, 100);
}

// The plane cuts one triangle of the two: each has its own light then.
TEST(BeamPoint, TakesTrianglesOfFourCornersApartWhereThePlaneCutsOne) {
    const std::array<Vec3, 4> corners = {Vec3(0, 0, 1), Vec3(2, 0, 1), Vec3(2, 1, 1),
                                         Vec3(0, 1, -1)};
    for (const bool cut_first : {false, true}) {
        BeamSet set;
        for (std::size_t i = 0; i < 4; ++i)
            set.rays.push_back({corners[(i + (cut_first ? 2 : 0)) % 4], -Vec3::UnitZ()});
        Beam beam;
        beam.corners = {0, 1, 2, 3};
        beam.first_share = 0.5F;
        set.beams = {beam};
        std::array<BeamHit, 2> hits;
        const std::uint8_t whole = cut_first ? 1 : 0;
        ASSERT_EQ(test_beam(set, beam, TestPlane({1.5F, 0.2F, 0}, Vec3::UnitZ()), hits), 1);
        EXPECT_EQ(hits[0].triangle, whole);
        EXPECT_NEAR(hits[0].area, 1, 1e-6);
        EXPECT_NEAR(hits[0].flux_share, 0.5, 1e-6);
        ASSERT_EQ(test_beam(set, beam, TestPlane({0.5F, 0.35F, 0}, Vec3::UnitZ()), hits), 1);
        EXPECT_EQ(hits[0].triangle, 1 - whole);
        EXPECT_NEAR(hits[0].area, 0.75, 1e-6);
        EXPECT_NEAR(hits[0].flux_share, 0.375, 1e-6);
    }
}

}  // namespace
}  // namespace caustics::beamtree
