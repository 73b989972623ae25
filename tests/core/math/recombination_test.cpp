#include "core/math/recombination.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/statistics.h"

namespace caustics {
namespace {

constexpr int points = 60;

/// Functions of the place along a line: its powers.
Eigen::MatrixXd powers(int count) {
    Eigen::MatrixXd values(count, points);
    for (int i = 0; i < points; ++i)
        for (int k = 0; k < count; ++k) values(k, i) = std::pow(2 * (i + 0.5) / points - 1, k);
    return values;
}

std::vector<double> uneven_weights() {
    std::vector<double> weights;
    for (int i = 0; i < points; ++i) weights.push_back(1 + i % 7);
    return weights;
}

Eigen::VectorXd sums(const Eigen::MatrixXd& values, const std::vector<double>& weights) {
    return values * Eigen::Map<const Eigen::VectorXd>(weights.data(), points);
}

TEST(Recombination, KeepsTheSumsWithAsManyPointsAsFunctions) {
    for (const int count : {1, 2, 5, 16}) {
        const Eigen::MatrixXd values = powers(count);
        for (std::uint64_t seed = 1; seed <= 10; ++seed) {
            std::vector<double> weights = uneven_weights();
            Rng rng(seed, Stage::test, 0);
            recombine(weights, values, rng);
            EXPECT_LT((sums(values, weights) - sums(values, uneven_weights())).norm(), 1e-11);
            EXPECT_EQ(std::ranges::count_if(weights, [](double w) { return w != 0; }), count);
            EXPECT_GE(std::ranges::min(weights), 0);
        }
    }
}

TEST(Recombination, KeepsWeightsOnAverage) {
    const Eigen::MatrixXd values = powers(5);
    std::vector<support::Moments> found(points);
    for (std::uint64_t seed = 1; seed <= 4000; ++seed) {
        std::vector<double> weights = uneven_weights();
        Rng rng(seed, Stage::test, 0);
        recombine(weights, values, rng);
        for (std::size_t i = 0; i < points; ++i) found[i].add(weights[i]);
    }
    const double bound = support::sidak_bound(points);
    for (std::size_t i = 0; i < points; ++i)
        EXPECT_LT(std::abs(found[i].mean() - uneven_weights()[i]),
                  bound * found[i].standard_error())
            << i;
}

TEST(Recombination, LeavesFewPointsAsTheyAre) {
    std::vector<double> weights = {1, 0, 2};
    Rng rng(1, Stage::test, 0);
    recombine(weights, powers(2).leftCols(3), rng);
    EXPECT_EQ(weights, (std::vector<double>{1, 0, 2}));
}

// Points of no value, as of light that nothing meets, do not stop it.
TEST(Recombination, EndsWherePointsAreAlikeOrOfNoValue) {
    Eigen::MatrixXd values = Eigen::MatrixXd::Ones(3, points);
    values.rightCols(20).setZero();
    std::vector<double> weights(points, 1.0);
    Rng rng(1, Stage::test, 0);
    recombine(weights, values, rng);
    EXPECT_LE(std::ranges::count_if(weights, [](double w) { return w != 0; }), 3);
    EXPECT_NEAR(sums(values, weights)[0], 40, 1e-11);
}

}  // namespace
}  // namespace caustics
