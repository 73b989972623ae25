#include "core/light_path/stratified_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/math/rng.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

Vec2d point(const StratifiedSquare& square, std::uint64_t stratum, Vec2d jitter) {
    square.place(stratum, {&jitter.x(), 1}, {&jitter.y(), 1});
    return jitter;
}

TEST(StratifiedSquare, SizesAreNextToWhatIsAsked) {
    for (std::uint64_t size = 1; size < 3'000'000; size += 1 + size / 7) {
        const std::uint64_t more = StratifiedSquare::at_least(size).size();
        const std::uint64_t less = StratifiedSquare::at_most(size).size();
        EXPECT_GE(more, size);
        EXPECT_LE(less, size);
        EXPECT_GE(less, 1U);
        if (size < 200) {  // grids without blocks
            EXPECT_EQ(StratifiedSquare::at_least(more).size(), more);
            EXPECT_EQ(StratifiedSquare::at_most(less).size(), less);
        }
        if (size < 10'000) continue;
        EXPECT_LT(static_cast<double>(more), 1.03 * static_cast<double>(size));
        EXPECT_GT(static_cast<double>(less), 0.97 * static_cast<double>(size));
    }
}

// Every cell of the finest grid holds exactly one point, for sizes with and without blocks.
TEST(StratifiedSquare, FillsEachStratumOnce) {
    for (const std::uint64_t size : {1U, 5U, 100U, 1'024U, 3'000U, 50'000U, 300'000U}) {
        const StratifiedSquare square = StratifiedSquare::at_least(size);
        std::set<std::pair<double, double>> corners;
        double x = 0, y = 0;
        for (std::uint64_t i = 0; i < square.size(); ++i) {
            const Vec2d low = point(square, i, Vec2d::Zero());
            corners.emplace(low.x(), low.y());
            const Vec2d high = point(square, i, Vec2d::Constant(1 - 0x1p-32));
            ASSERT_TRUE((high.array() < 1).all() && (low.array() >= 0).all());
            const double area = (high - low).prod() * static_cast<double>(square.size());
            ASSERT_NEAR(area, 1, 1e-6);
            x += (low + high).x() / 2;
            y += (low + high).y() / 2;
        }
        EXPECT_EQ(corners.size(), square.size());
        EXPECT_NEAR(x / static_cast<double>(square.size()), 0.5, 1e-6);
        EXPECT_NEAR(y / static_cast<double>(square.size()), 0.5, 1e-6);
    }
}

TEST(StratifiedSquare, IsUniformAndEvenerThanChance) {
    const StratifiedSquare square = StratifiedSquare::at_least(40'000);
    constexpr int side = 10;  // does not divide the grid's sides
    std::vector<double> counts(side * side);
    Rng rng(1, Stage::test, 0);
    for (std::uint64_t i = 0; i < square.size(); ++i) {
        const double jx = rng.next_fine(), jy = rng.next_fine();
        const Vec2d p = point(square, i, {jx, jy});
        counts[static_cast<std::size_t>(p.x() * side) * side +
               static_cast<std::size_t>(p.y() * side)] += 1;
    }
    const double expected = static_cast<double>(square.size()) / (side * side);
    double chi_square = 0;
    for (const double count : counts) chi_square += std::pow(count - expected, 2) / expected;
    EXPECT_LT(chi_square, 50) << "99 degrees of freedom if it were random";
}

// Runs of consecutive strata stay together: that is what the tracing gains from.
TEST(StratifiedSquare, NeighboursInTheWalkAreNeighboursInTheSquare) {
    const StratifiedSquare square = StratifiedSquare::at_least(1'000'000);
    const double stratum = 1 / std::sqrt(static_cast<double>(square.size()));
    double sum = 0;
    for (std::uint64_t i = 1; i < square.size(); ++i)
        sum += (point(square, i, Vec2d::Zero()) - point(square, i - 1, Vec2d::Zero())).norm();
    EXPECT_LT(sum / static_cast<double>(square.size()), 2 * stratum);
}

TEST(StratifiedSquare, IsWalkedToAndFro) {
    const StratifiedSquare square = StratifiedSquare::at_least(200);
    const double column = (point(square, 1, Vec2d::Zero()) - point(square, 0, Vec2d::Zero())).x();
    const double row = 1 / (column * static_cast<double>(square.size()));
    for (std::uint64_t i = 1; i < square.size(); ++i) {
        const Vec2d step = point(square, i, Vec2d::Zero()) - point(square, i - 1, Vec2d::Zero());
        EXPECT_NEAR(std::abs(step.x()) / column + std::abs(step.y()) / row, 1, 1e-9) << i;
    }
}

}  // namespace
}  // namespace caustics
