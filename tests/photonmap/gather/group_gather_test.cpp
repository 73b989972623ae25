#include <gtest/gtest.h>

#include <cmath>

#include "photonmap/tree/build_tree.h"
#include "tests/photonmap/photon_sets.h"

namespace caustics::photonmap {
namespace {

using test::Found;
using test::linear_scan;
using test::photon_at;
using test::store_of;

ReceiverPoint point_at(const Vec3& x, const Vec3& normal = Vec3::UnitZ()) {
    ReceiverPoint point;
    point.position = x;
    point.geometric_normal = point.shading_normal = point.wo = normal;
    point.uv = Vec2::Zero();
    return point;
}

std::vector<std::vector<Found>> gathered(std::span<const Photon> photons,
                                         std::span<const ReceiverPoint> points,
                                         const GatherLimits& limits, GatherScratch& scratch) {
    std::vector<std::vector<Found>> all(points.size());
    build_tree(TreeKind::packed, store_of(photons), widest_isa())
        ->gather(points, limits, scratch, [&](std::size_t i, const GatheredPhotons& answer) {
            for (std::size_t k = 0; k < answer.count; ++k)
                all[i].push_back(
                    {answer.squared_distance[k], answer.energy[k], answer.direction[k]});
            std::ranges::sort(all[i]);
        });
    return all;
}

/// Returns how many points were answered in groups.
std::uint64_t expect_as_scan(std::span<const Photon> photons, std::span<const ReceiverPoint> points,
                             const GatherLimits& limits) {
    GatherScratch scratch;
    const auto found = gathered(photons, points, limits, scratch);
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_EQ(found[i], linear_scan(photons, points[i], limits)) << "point " << i;
    EXPECT_EQ(scratch.grouped_queries + scratch.single_queries, points.size());
    return scratch.grouped_queries;
}

/// On the square [-1, 1]^2 at z = 0.
std::vector<Photon> scattered(std::size_t count, std::uint64_t seed) {
    Rng rng(seed, Stage::test, count);
    std::vector<Photon> photons;
    for (std::size_t i = 0; i < count; ++i)
        photons.push_back(photon_at({2 * rng.next() - 1, 2 * rng.next() - 1, 0}));
    return photons;
}

TEST(GroupGather, AnswersFourNeighboursTogether) {
    const std::vector<Photon> photons = scattered(5'000, 1);
    for (const std::size_t count : {4U, 5U, 64U}) {
        std::vector<ReceiverPoint> points;
        for (std::size_t i = 0; i < count; ++i)
            points.push_back(point_at({1e-4F * static_cast<float>(i), 0, 0}));
        GatherScratch scratch;
        // The first of all knows no distance yet.
        gathered(photons, points, {.nearest = 50, .max_radius = 0.2F}, scratch);
        EXPECT_EQ(scratch.grouped_queries, count);
    }
}

// All photons of a small map, but a few times N of a large one.
TEST(GroupGather, CollectsIntoAsMuchMemoryAsAGroupNeeds) {
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 16; ++i) points.push_back(point_at({1e-3F * static_cast<float>(i), 0, 0}));
    GatherScratch scratch;
    gathered(scattered(50'000, 2), points, {.nearest = 50, .max_radius = 0.2F}, scratch);
    EXPECT_EQ(scratch.grouped_queries, points.size());
    EXPECT_GE(scratch.group_found.candidates().capacity, 200U);
    EXPECT_LE(scratch.group_found.candidates().capacity, 5'000U);
}

// Between neighbouring numbers there is no middle to part points at.
TEST(GroupGather, AnswersPointsThatCannotBeParted) {
    const std::vector<Photon> photons = scattered(1'000, 3);
    for (float first : {0.5F, std::nextafter(0.5F, 1.0F)}) {
        std::vector<ReceiverPoint> points;
        for (int i = 0; i < 200; ++i)
            points.push_back(point_at({i % 2 == 0 ? first : std::nextafter(first, 1.0F), 0, 0}));
        expect_as_scan(photons, points, {.nearest = 20, .max_radius = 1});
    }
}

// Of those that arrive from above there are ten times as many as of those from below: what bounds a search above says nothing
// below.
TEST(GroupGather, BoundsNoSearchByThatOfAnotherSide) {
    std::vector<Photon> photons = scattered(20'000, 4);
    const DirectionCode from_below = encode_direction(-Vec3::UnitZ());
    for (std::size_t i = 0; i < photons.size(); i += 10) {
        photons[i].theta = from_below.theta;
        photons[i].phi = from_below.phi;
    }
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 256; ++i) {
        const Vec3 at(2e-3F * static_cast<float>(i % 16), 2e-3F * static_cast<float>(i / 16), 0);
        points.push_back(point_at(at, (i / 16 % 8 < 4 ? 1.0F : -1.0F) * Vec3::UnitZ()));
    }
    EXPECT_GT(expect_as_scan(photons, points, {.nearest = 40, .max_radius = 0.5F}), 100U);
}

// Few photons, some of them from below, then a thousand times as many: what a group would collect, by the distance known from
// before, is more than it has room for, also where sides are looked at.
TEST(GroupGather, PartsAGroupThatCameToDenserPhotons) {
    const DirectionCode from_below = encode_direction(-Vec3::UnitZ());
    std::vector<Photon> photons = scattered(100, 7);
    for (Photon& photon : scattered(20'000, 8)) {
        photon.position[0] = 3 + photon.position[0] / 2;
        photon.position[1] /= 2;
        photons.push_back(photon);
    }
    for (std::size_t i = 0; i < photons.size(); i += 2) {
        photons[i].theta = from_below.theta;
        photons[i].phi = from_below.phi;
    }
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 8; ++i) points.push_back(point_at({1e-3F * static_cast<float>(i), 0, 0}));
    for (int i = 0; i < 16; ++i)
        points.push_back(point_at({3 + 0.02F * static_cast<float>(i), 0, 0}));
    EXPECT_LT(expect_as_scan(photons, points, {.nearest = 20, .max_radius = 1}), points.size());
}

// A cluster of photons aside of a group: the members on its other side are farther from it by their way to the centre.
TEST(GroupGather, ReachesFromEveryMemberAsFarAsFromTheCentre) {
    for (const Vec3& towards : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0.8F, 0.6F)}) {
        std::vector<Photon> photons;
        for (int i = 0; i < 500; ++i)
            photons.push_back(photon_at((0.05F + 1e-6F * static_cast<float>(i)) * towards));
        for (const float centre : {-0.005F, 0.0F, 0.005F}) {
            std::vector<ReceiverPoint> points;
            for (const float along : {-0.025F, -0.02F, 0.0F, 0.01F, 0.025F})
                points.push_back(point_at((centre + along) * towards));
            EXPECT_EQ(expect_as_scan(photons, points, {.nearest = 60, .max_radius = 0.2F}), 5U);
        }
    }
}

// One of many photons lies on a surface that faces elsewhere: wherever it lies in its bucket it is left out.
TEST(GroupGather, LeavesOutTheOnePhotonOfAnotherSurface) {
    std::uint64_t grouped = 0;
    for (std::size_t other = 0; other < 192; ++other) {
        std::vector<Photon> photons = scattered(192, 5);
        for (Photon& photon : photons) photon.flags = facing_flags({0, 0, 1});
        photons[other].flags = facing_flags({0, 0, -1});
        photons[other].position[0] = photons[other].position[1] = 0;
        std::vector<ReceiverPoint> points;
        for (int i = 0; i < 8; ++i)
            points.push_back(point_at({1e-3F * static_cast<float>(i), 0, 0}));
        grouped += expect_as_scan(photons, points, {.nearest = 20, .max_radius = 1});
    }
    EXPECT_GT(grouped, 1'000U);
}

// Copies of where surfaces face are those of the photons copied, to the last bit: the other surface's code differs in its
// high byte alone, and the common one's has twice the same byte, or 0 as memory that was never written, whatever bytes are
// taken for it.
TEST(GroupGather, CopiesWhereSurfacesFaceWhole) {
    const auto facing = [](unsigned flags) {
        const Facing at = facing_of(flags);
        return Vec3d(at.x, at.y, at.z).normalized();
    };
    for (const unsigned common : {0x0808U, 0x2828U, 0x4848U, 0x0008U, 0x0028U}) {
        const unsigned byte = common & 0xFFU;
        const Vec3d normal = facing(common);
        unsigned other = common;
        for (unsigned high = 0; high < 123 && facing(other).dot(normal) > -0.5; ++high)
            other = high << 8U | byte;
        ASSERT_LT(facing(other).dot(normal), 0);
        std::vector<Photon> photons = scattered(40, 6);
        const DirectionCode from = encode_direction(normal.cast<float>());
        for (Photon& photon : photons) {
            photon.flags = static_cast<std::uint16_t>(common);
            photon.theta = from.theta;
            photon.phi = from.phi;
        }
        std::vector<ReceiverPoint> points;
        for (int i = 0; i < 8; ++i)
            points.push_back(point_at({1e-3F * static_cast<float>(i), 0, 0}, normal.cast<float>()));
        const GatherLimits limits{.nearest = 60, .max_radius = 3};
        GatherScratch scratch;
        // In the second round the arrays hold what was copied in the first.
        for (std::size_t i = 0; i <= photons.size(); ++i) {
            std::vector<Photon> all = photons;
            if (i > 0) all[i - 1].flags = static_cast<std::uint16_t>(other);
            all.push_back(photon_at({9, 9, 9}));
            all.back().flags = static_cast<std::uint16_t>(other);
            const auto found = gathered(all, points, limits, scratch);
            for (std::size_t k = 0; k < points.size(); ++k)
                EXPECT_EQ(found[k], linear_scan(all, points[k], limits)) << common << " " << i;
        }
        EXPECT_EQ(scratch.single_queries, 0U);
    }
}

}  // namespace
}  // namespace caustics::photonmap
