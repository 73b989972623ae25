#include "experiments/run/counted_rays.h"

#include <gtest/gtest.h>

#include "experiments/run/method.h"
#include "tests/support/ball_before_mirror.h"

namespace caustics::experiments {
namespace {

std::optional<CountedRays> counted_by(const std::string& name, std::vector<std::string> parameters,
                                      int threads = 1) {
    const Scene scene(support::ball_before_mirror());
    parameters.emplace_back("max_bounces=3");
    const Method method = parse_method(name, parameters_node(parameters));
    const auto built = build(scene, method, RunOptions{});
    return counted_rays(scene, *built, 3, threads);
}

TEST(CountedRays, AreOneByOneUpToRootEventsAndSpreadBeyond) {
    const auto exact = counted_by("beamtree", {"mesh_resolution=24", "root_events=3"}).value();
    EXPECT_EQ(exact.asked, 512U);
    EXPECT_LE(exact.missed.value, 0.005);
    EXPECT_LE(exact.spread.value, 0.005);
    // Light that has passed the glass comes to the floor after a third event, at the mirror ball.
    const auto coarse = counted_by("beamtree", {"mesh_resolution=24"}).value();
    EXPECT_LE(coarse.missed.value, 0.01);
    EXPECT_GE(coarse.spread.value, 0.02);
}

TEST(CountedRays, AreTheSameForAnyNumberOfThreads) {
    const auto one = counted_by("beamtree", {"mesh_resolution=8"}, 1).value();
    const auto three = counted_by("beamtree", {"mesh_resolution=8"}, 3).value();
    EXPECT_EQ(one.spread.value, three.spread.value);
    EXPECT_EQ(one.missed.value, three.missed.value);
}

TEST(CountedRays, AreUnknownToMethodsThatSearchForNone) {
    EXPECT_FALSE(counted_by("photonmap", {"emitted=1000"}).has_value());
    EXPECT_FALSE(counted_by("beamtree", {"mesh_resolution=8", "intensity=area"}).has_value());
}

/// Misses every fourth ray, and spreads every eighth.
class Forgetful : public CausticEstimator {
public:
    void radiance(std::span<const ReceiverPoint>, std::span<Estimate>,
                  QueryContext&) const override {}
    void irradiance(std::span<const ReceiverPoint>, std::span<Estimate>,
                    QueryContext&) const override {}
    std::optional<std::vector<RayCount>> count_rays(std::span<const ArrivingLight> rays,
                                                    QueryContext&) const override {
        std::vector<RayCount> counts(rays.size(), RayCount::exact);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (i % 4 == 0) counts[i] = RayCount::missed;
            if (i % 8 == 1) counts[i] = RayCount::spread;
        }
        return counts;
    }
};

TEST(CountedRays, TellWhatIsMissedAndWhatIsSpread) {
    const Scene scene(support::ball_before_mirror());
    const auto rays = counted_rays(scene, Forgetful(), 3, 2).value();
    EXPECT_NEAR(rays.missed.value, 0.25, 0.02);
    EXPECT_NEAR(rays.missed.error, 0.019, 0.003);
    EXPECT_NEAR(rays.spread.value, 0.125, 0.02);
    CausticLedger ledger;
    ledger.light = {.sent = 1, .arrived = 1};
    const auto told = notes_on(rays, ledger);
    ASSERT_EQ(told.size(), 2U);
    EXPECT_NE(told[0].find("% of the light that arrives on receivers is not found"),
              std::string::npos);
    EXPECT_NE(told[1].find("is spread over images of polygons"), std::string::npos);
    // Light that the ledger tells of is not told again.
    ledger.light.arrived = 0.75;
    ledger.missed_by_pruning = 0.25;
    EXPECT_EQ(notes_on(rays, ledger).size(), 1U);
}

}  // namespace
}  // namespace caustics::experiments
