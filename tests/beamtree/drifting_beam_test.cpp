#include "beamtree/light/drifting_beam.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"

namespace caustics::beamtree {
namespace {

// Two triangles with a common edge, whose rays move each in its own way.
BeamSet pair_of_triangles(std::uint64_t seed) {
    Rng rng(seed, Stage::test, 0);
    const auto number = [&rng] { return rng.next() - 0.5F; };
    BeamSet set;
    set.light.drifts = true;
    for (const Vec2& corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)}) {
        const Vec3 start(corner.x(), corner.y(), 1);
        const Vec3 down = Vec3(0.2F * number(), 0.2F * number(), -1);
        const Vec3 turn(0.3F * number(), 0.3F * number(), 0);
        set.rays.push_back({start, down.normalized()});
        set.ends[0].push_back({start, (down - turn).normalized()});
        set.ends[1].push_back({start, (down + turn).normalized()});
    }
    Beam first, second;
    first.corners = {0, 1, 2, Beam::none};
    second.corners = {0, 2, 3, Beam::none};
    set.beams = {first, second};
    return set;
}

// Of both beams at a place of the bin: in how many does the point lie?
int holders(const BeamSet& set, const TestPlane& plane, double place) {
    int count = 0;
    for (const Beam& beam : set.beams)
        count += test_triangle(set.triangle(beam, 0, place), 0, plane) ? 1 : 0;
    return count;
}

TEST(DriftingBeam, FindsTheIntervalsThatNarrowStepsFind) {
    constexpr int steps = 2000;
    int crossed = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const BeamSet set = pair_of_triangles(seed);
        Rng rng(seed, Stage::test, 1);
        for (int trial = 0; trial < 10; ++trial) {
            const Vec3 point(2.4F * rng.next() - 1.2F, 2.4F * rng.next() - 1.2F, 0);
            const TestPlane plane(point, Vec3::UnitZ());
            std::vector<BeamHit> hits;
            for (const std::uint32_t beam : {0U, 1U})
                find_in_drifting_beam(set, {0, beam}, plane, hits);
            double found = 0;
            double inverse_area = 0;
            for (const BeamHit& hit : hits) {
                EXPECT_LT(hit.from, hit.to);
                found += (hit.to - hit.from) / 2;
                inverse_area += (hit.to - hit.from) / 2 / hit.area;
            }
            double share = 0;
            double brute = 0;
            for (int i = 0; i < steps; ++i) {
                const double place = -1 + 2 * (i + 0.5) / steps;
                share += holders(set, plane, place) / (1.0 * steps);
                for (const Beam& beam : set.beams)
                    if (const auto hit = test_triangle(set.triangle(beam, 0, place), 0, plane))
                        brute += 1 / (hit->area * steps);
            }
            // Corners of unit rays move linearly to a share of their turn.
            EXPECT_NEAR(found, share, 0.02) << seed << " " << point.transpose();
            EXPECT_NEAR(inverse_area, brute, 0.02) << seed << " " << point.transpose();
            crossed += found > 0.05 && found < 0.95 ? 1 : 0;
        }
    }
    EXPECT_GT(crossed, 30);
}

// Inside a mesh a point is held by exactly one triangle at every wavelength, on common edges as well.
TEST(DriftingBeam, TilesHoldEachPointOnce) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const BeamSet set = pair_of_triangles(seed);
        for (const Vec3& point : {Vec3(0, 0, 0), Vec3(0.1F, 0.1F, 0), Vec3(-0.2F, 0.3F, 0)}) {
            std::vector<BeamHit> hits;
            const TestPlane plane(point, Vec3::UnitZ());
            for (const std::uint32_t beam : {0U, 1U})
                find_in_drifting_beam(set, {0, beam}, plane, hits);
            double covered = 0;
            for (const BeamHit& hit : hits) covered += hit.to - hit.from;
            EXPECT_NEAR(covered, 2, 1e-12) << seed;
        }
    }
}

TEST(BinPlaces, GoWithTheIndexOfRefraction) {
    const Ior glass = Ior::cauchy(1.6, 0.02);
    const WavelengthBin bin = wavelength_bins(3)[0];
    const BinPlaces places(bin, glass);
    const double first = glass.at(bin.from);
    const double last = glass.at(bin.to);
    for (double place = -1; place <= 1; place += 0.1) {
        const double nm = places.wavelength_at(place);
        EXPECT_NEAR(places.place_of(nm), place, 1e-9);
        EXPECT_NEAR(glass.at(static_cast<float>(nm)),
                    ((1 - place) * first + (1 + place) * last) / 2, 2e-3 * std::abs(last - first));
    }
}

}  // namespace
}  // namespace caustics::beamtree
