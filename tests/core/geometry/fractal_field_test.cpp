#include "core/geometry/fractal_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "tests/core/mesh/mesh_measures.h"

namespace caustics {
namespace {

FractalField field(int levels, double hurst = 0.6) {
    FractalField made;
    made.levels = levels;
    made.hurst = hurst;
    made.rms = 0.0025;
    made.lowest = 2;
    made.seed = 1996;
    made.half_size = {0.3, 0.2};
    return made;
}

double mean_square(const HeightGrid& grid) {
    double sum = 0;
    for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.columns; ++i) {
            const auto z = static_cast<double>(grid.heights[grid.index(i, j)]);
            sum += z * z;
        }
    return sum / grid.columns / grid.rows;
}

TEST(FractalField, HasItsRmsAndRepeats) {
    const HeightGrid grid = fractal_grid(field(6));
    EXPECT_NEAR(std::sqrt(mean_square(grid)), 0.0025, 1e-9);
    for (int i = 0; i <= grid.columns; ++i) {
        EXPECT_EQ(grid.heights[grid.index(i, 0)], grid.heights[grid.index(i, grid.rows)]);
        EXPECT_EQ(grid.heights[grid.index(0, i)], grid.heights[grid.index(grid.columns, i)]);
    }
}

TEST(FractalField, IsTheSumOfItsWaves) {
    const FractalField four = field(3);
    const HeightGrid grid = fractal_grid(four, true);
    for (const auto& [i, j] : {std::pair(0, 0), std::pair(5, 2), std::pair(3, 7)}) {
        std::complex<double> z = 0;
        std::complex<double> slope = 0;
        for (int n = -3; n <= 3; ++n)
            for (int m = -3; m <= 3; ++m) {
                const auto wave =
                    fractal_amplitude(four, m, n) * std::polar(1.0, 2 * pi_d * (m * i + n * j) / 8);
                z += wave;
                slope += std::complex<double>(0, 2 * pi_d * n / 0.4) * wave;
            }
        EXPECT_NEAR(grid.heights[grid.index(i, j)], z.real(), 1e-6);
        EXPECT_NEAR(grid.slopes[grid.index(i, j)].y(), slope.real(), 1e-5);
    }
}

// What a level adds at the points of the one before are the waves between their limits.
TEST(FractalField, FinerLevelsAddTheirBandAndMoveNothingElse) {
    const HeightGrid coarse = fractal_grid(field(3), true);
    const HeightGrid fine = fractal_grid(field(4), true);
    for (int j = 0; j < 8; j += 3)
        for (int i = 0; i < 8; ++i) {
            std::complex<double> band = 0;
            for (int n = -7; n <= 7; ++n)
                for (int m = -7; m <= 7; ++m)
                    if (std::max(std::abs(m), std::abs(n)) > 3)
                        band += fractal_amplitude(field(4), m, n) *
                                std::polar(1.0, 2 * pi_d * (m * i + n * j) / 8);
            EXPECT_NEAR(fine.heights[fine.index(2 * i, 2 * j)] - coarse.heights[coarse.index(i, j)],
                        band.real(), 1e-6);
        }
}

TEST(FractalField, IsAFunctionOfItsSeed) {
    FractalField other = field(5);
    const HeightGrid first = fractal_grid(other);
    EXPECT_EQ(first.heights, fractal_grid(other).heights);
    other.seed = 1997;
    EXPECT_NE(first.heights, fractal_grid(other).heights);
}

// Slope of log E (z(x + d) - z(x))^2 over log d, by least squares over d = 8 .. 128 cells.
double measured_slope(const HeightGrid& grid) {
    double sums[4] = {0, 0, 0, 0};
    for (int exponent = 3; exponent <= 7; ++exponent) {
        const int lag = 1 << exponent;
        double square = 0;
        for (int j = 0; j < grid.rows; ++j)
            for (int i = 0; i < grid.columns; ++i) {
                const float z = grid.heights[grid.index(i, j)];
                const float along_x = grid.heights[grid.index((i + lag) % grid.columns, j)] - z;
                const float along_y = grid.heights[grid.index(i, (j + lag) % grid.rows)] - z;
                square += static_cast<double>(along_x * along_x + along_y * along_y);
            }
        const double x = std::log(lag);
        const double y = std::log(square);
        sums[0] += x;
        sums[1] += y;
        sums[2] += x * x;
        sums[3] += x * y;
    }
    return (sums[3] - sums[0] * sums[1] / 5) / (sums[2] - sums[0] * sums[0] / 5);
}

TEST(FractalField, StructureFunctionGrowsAsTwiceTheHurstExponent) {
    FractalField square = field(10);
    square.half_size = {1, 1};
    square.lowest = 1;
    for (const double hurst : {0.3, 0.5}) {
        square.hurst = hurst;
        EXPECT_NEAR(measured_slope(fractal_grid(square)), 2 * hurst, 0.1) << hurst;
    }
    // Smooth ground lives by waves longer than the square, which it has none of: the sum over those
    // it has gives 1.437.
    square.hurst = 0.8;
    EXPECT_NEAR(measured_slope(fractal_grid(square)), 1.437, 0.1);
}

TEST(FractalField, LowestDampsLongWaves) {
    const FractalField damped = field(5);
    FractalField plain = damped;
    plain.lowest = 1;
    EXPECT_NEAR(std::abs(fractal_amplitude(damped, 1, 0) / fractal_amplitude(plain, 1, 0)), 0.25,
                1e-12);
    EXPECT_EQ(fractal_amplitude(damped, 2, 0), fractal_amplitude(plain, 2, 0));
    EXPECT_EQ(fractal_amplitude(damped, 0, 0), 0.0);
}

TEST(FractalField, RefusesLevelsThatMakeNoMesh) {
    EXPECT_THROW(fractal_grid(field(1)), InputError);
    EXPECT_THROW(fractal_grid(field(13)), InputError);
}

TEST(HeightGrid, TakesTheGridsSlopesOrDifferences) {
    HeightGrid grid = fractal_grid(field(7));
    const TriangleMesh exact = tessellate_grid(grid);
    EXPECT_EQ(exact.triangles.size(), 2U * 128 * 128);
    ASSERT_EQ(exact.patches.size(), 1U);
    EXPECT_EQ(exact.positions.back().head<2>(), Vec2(0.3F, 0.2F));
    EXPECT_EQ(exact.uvs.back(), Vec2(1, 1));
    EXPECT_EQ(test::euler_characteristic(exact), 1);
    HeightGrid plane{.columns = 3, .rows = 2, .half_size = {3, 1}};
    for (int j = 0; j <= 2; ++j)
        for (int i = 0; i <= 3; ++i) plane.heights.push_back(static_cast<float>(i - 0.5 * j));
    for (const Vec3& normal : tessellate_grid(plane).normals)
        EXPECT_LT((normal - Vec3(-0.5F, 0.5F, 1).normalized()).norm(), 1e-6F);
}

}  // namespace
}  // namespace caustics
