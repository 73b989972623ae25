#include "experiments/verify/agreement.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/base/error.h"
#include "experiments/verify/cell_light.h"
#include "experiments/verify/more_work.h"
#include "experiments/verify/verify_scene.h"

namespace caustics::experiments {
namespace {

using Three = std::array<Difference, work_steps>;

/// Differences that fall as work^-order towards `limit`.
Three falling(double first, double order, double limit, double error) {
    Three all;
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i] = {limit + first * std::pow(std::pow(work_factor, i), -order), error};
    return all;
}

TEST(Agreement, ConvergesWhereTheDifferenceFallsAsAPowerOfTheWork) {
    for (const double order : {0.3, 0.5, 1.0}) {
        const Convergence found = convergence(falling(-0.13, order, 0, 1e-4), Limit{});
        EXPECT_TRUE(found.shrinks) << order;
        EXPECT_NEAR(found.order, order, 0.01);
        ASSERT_TRUE(found.remaining);
        EXPECT_NEAR(found.remaining->value, 0, 2e-3);
    }
}

TEST(Agreement, DoesNotConvergeWhereTooMuchRemains) {
    EXPECT_FALSE(convergence(falling(0.1, 0.5, 0.03, 1e-4), Limit{}).shrinks);
    EXPECT_FALSE(convergence(falling(0, 1, 0.03, 1e-3), Limit{}).shrinks) << "a constant factor";
    EXPECT_FALSE(convergence(falling(0.1, 0.1, 0, 1e-4), Limit{}).shrinks) << "too slow";
    EXPECT_FALSE(convergence(falling(0.01, -0.5, 0, 1e-4), Limit{}).shrinks) << "it grows";
}

// The Aitken limit's own error: all three values carry theirs.
TEST(Agreement, TheExtrapolationStatesItsError) {
    const Convergence found = convergence(falling(0.1, 0.5, 0, 0.002), Limit{});
    ASSERT_TRUE(found.remaining);
    EXPECT_GT(found.remaining->error, 0.002);
    EXPECT_LT(found.remaining->error, 0.02);
}

TEST(Agreement, LimitsFollowFromTwoPerCentAndFiveErrors) {
    EXPECT_DOUBLE_EQ(Limit{}.largest_error(), 0.004);
    EXPECT_TRUE(Limit{}.can_judge({0, 0.004}));
    EXPECT_FALSE(Limit{}.can_judge({0, 0.0041}));
    EXPECT_NEAR(cell_limit().share, 0.098, 1e-4);
    EXPECT_TRUE(Limit{}.is_known({0.1, 0.02}));
    EXPECT_FALSE(Limit{}.is_known({0.7, 0.2})) << "nobody knows how it changes";
}

/// A method's light: the same in all cells but for a factor in some, over the mean and a relative error.
CellLight light(double factor, double error) {
    CellLight found;
    for (std::size_t cell = 0; cell <= CellLight::cells; ++cell) {
        const double cells = cell == CellLight::cells ? 1 : std::sqrt(CellLight::cells);
        found.mean[cell] = 2 * factor;
        found.error[cell] = 2 * error * cells;
    }
    return found;
}

TEST(Agreement, HoldsWithinTwoPerCentAndFiveErrors) {
    const CellLight truth = light(1, 0.001);
    EXPECT_TRUE(gap(light(1.005, 0.001), truth).is_within());
    EXPECT_FALSE(gap(light(1.0101, 0.001), truth).is_within()) << "seven standard errors";
    EXPECT_FALSE(gap(light(1.021, 0.0039), truth).is_within()) << "more than 2 %";
    EXPECT_TRUE(gap(light(1.01, 0.003), truth).is_within());
    EXPECT_TRUE(gap(light(1.01, 0.0038), truth).can_judge());
    EXPECT_FALSE(gap(light(1.01, 0.0041), truth).can_judge());
    EXPECT_TRUE(gap(light(1.5, 0.01), truth).can_judge()) << "clearly off";
}

TEST(Agreement, DoesNotHoldWhereLightIsMovedAbout) {
    const CellLight truth = light(1, 0.001);
    CellLight moved = truth;
    moved.mean[3] *= 1.15;
    moved.mean[11] *= 0.85;
    const CellGap found = gap(moved, truth);
    EXPECT_EQ(found.cells_off, 2U);
    EXPECT_FALSE(found.is_within());
    EXPECT_NEAR(std::abs(found.worst_cell.value), 0.15, 1e-12);
}

TEST(Agreement, ABlackReferenceWantsABlackPicture) {
    EXPECT_TRUE(gap(light(0, 0), light(0, 0)).is_within());
    EXPECT_FALSE(gap(light(1, 0), light(0, 0)).is_within());
}

TEST(Agreement, AsksForTheErrorThatIsMissing) {
    EXPECT_NEAR(excess_of_truth(light(1, 0.004)), 2, 1e-9);
    EXPECT_EQ(excess_of_truth(light(1, 0.001)), 1);
    EXPECT_NEAR(gap(light(1, 0.008), light(1, 0)).excess_of_found, 2, 1e-9);
}

TEST(Agreement, WhatConvergesIsAllowedWhereThatIsAskedFor) {
    SceneReport report{{{"a method", Agreement::converges, ""}, {"a fact", {}, ""}}};
    EXPECT_FALSE(report.holds());
    EXPECT_TRUE(report.holds(true));
    EXPECT_NE(report.text().find("verify: not all holds: 1 converges"), std::string::npos);
    for (const Agreement other : {Agreement::fails, Agreement::unsure}) {
        report.findings.front().verdict = other;
        EXPECT_FALSE(report.holds(true));
    }
}

TEST(MoreWork, RaisesWhatTheMethodsTimeGrowsWith) {
    EXPECT_EQ(MethodAsGiven("beamtree", {"mesh_resolution=20"}).with_more_work(16).work_text(),
              "mesh_resolution=80");
    EXPECT_EQ(
        MethodAsGiven("photonmap", {"photons=1000", "nearest=20"}).with_more_work(4).work_text(),
        "photons=4000");
    EXPECT_EQ(MethodAsGiven("photonmap", {"emitted=1000"}).with_more_work(4).work_text(),
              "emitted=4000");
    EXPECT_EQ(MethodAsGiven("illuminationmap", {"emitted=1000", "resolution=10"})
                  .with_more_work(4)
                  .work_text(),
              "emitted=4000 resolution=20");
    EXPECT_THROW(MethodAsGiven("beamtree", {"mesh_resolution=4000"}).with_more_work(4), InputError);
}

}  // namespace
}  // namespace caustics::experiments
