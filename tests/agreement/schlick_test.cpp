#include <gtest/gtest.h>

#include <cmath>

#include "core/material/bsdf.h"
#include "core/math/rng.h"
#include "core/math/sampling.h"
#include "tests/support/build_scene.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

const float alphas[] = {1, 0.3F, 0.1F, 0.03F, 0.01F};
const float cosines[] = {0.95F, 0.6F, 0.2F};

const Vec3 normal = Vec3::UnitZ();

Vec3 direction(float cosine, float phi = 0.3F) {
    const float sine = std::sqrt(1 - cosine * cosine);
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

// Integrates f(wi) over the upper hemisphere by the midpoint rule in (cos^2 theta, phi) warped so
// that steps are fine near the mirror direction: the polar axis is that direction.
template <typename F>
double integrate(const Vec3& wo, const F& f) {
    constexpr int rings = 2000;
    constexpr int sectors = 64;
    const Vec3d axis(-static_cast<double>(wo.x()), -static_cast<double>(wo.y()),
                     static_cast<double>(wo.z()));
    const Vec3d u = axis.unitOrthogonal();
    const Vec3d v = axis.cross(u);
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        // theta = pi t^3 makes the step grow from the axis outwards.
        const double t = (i + 0.5) / rings;
        const double theta = pi_d * t * t * t;
        const double measure = std::sin(theta) * 3 * pi_d * t * t / rings * 2 * pi_d / sectors;
        for (int j = 0; j < sectors; ++j) {
            const double phi = 2 * pi_d * (j + 0.5) / sectors;
            const Vec3d wi =
                std::cos(theta) * axis + std::sin(theta) * (std::cos(phi) * u + std::sin(phi) * v);
            if (wi.z() > 0) sum += static_cast<double>(f(wi.cast<float>())) * measure;
        }
    }
    return sum;
}

double albedo_by_quadrature(const Bsdf& bsdf, const Vec3& wo) {
    return integrate(wo, [&](const Vec3& wi) {
        return evaluate(bsdf, Vec2::Zero(), normal, wo, wi)[0] * wi.z();
    });
}

TEST(Schlick, AlbedoAtAlphaOneIsTheClosedForm) {
    // The rim of the hemisphere cuts the quadrature's cells: 1e-3 of the value at most.
    for (const float v : {1.0F, 0.95F, 0.6F, 0.2F, 0.05F}) {
        const double expected = 1.25 - 2 * static_cast<double>(v) / 3;
        EXPECT_NEAR(albedo_by_quadrature(support::schlick(1, 1), direction(v)) / expected, 1, 2e-3)
            << "v = " << v;
    }
}

TEST(Schlick, SamplesHaveTheQuadraturesAlbedo) {
    for (const float alpha : alphas)
        for (const float v : cosines) {
            const Bsdf bsdf = support::schlick(1, alpha);
            const Vec3 wo = direction(v);
            support::Moments albedo;
            for (std::uint64_t i = 0; i < 200'000; ++i) {
                Rng rng(1, Stage::test, i);
                const float u0 = rng.next();
                const float u1 = rng.next();
                const float u2 = rng.next();
                const auto wi = sample_direction(bsdf, normal, wo, u0, u1, u2);
                double value = 0;
                if (wi && wi->z() > 0)
                    value = static_cast<double>(evaluate(bsdf, Vec2::Zero(), normal, wo, *wi)[0] *
                                                wi->z() / direction_pdf(bsdf, normal, wo, *wi));
                albedo.add(value);
            }
            EXPECT_NEAR(albedo.mean(), albedo_by_quadrature(bsdf, wo),
                        4.5 * albedo.standard_error() + 1e-3 * albedo.mean())
                << "alpha " << alpha << ", v " << v;
        }
}

TEST(Schlick, DensityIntegratesToTheShareOfSamplesAbove) {
    for (const float alpha : alphas)
        for (const float v : cosines) {
            const Bsdf bsdf = support::schlick(1, alpha);
            const Vec3 wo = direction(v);
            const double integral =
                integrate(wo, [&](const Vec3& wi) { return direction_pdf(bsdf, normal, wo, wi); });
            EXPECT_LE(integral, 1 + 1e-3);
            constexpr int count = 100'000;
            int above = 0;
            for (std::uint64_t i = 0; i < count; ++i) {
                Rng rng(2, Stage::test, i);
                const float u0 = rng.next();
                const float u1 = rng.next();
                const float u2 = rng.next();
                if (sample_direction(bsdf, normal, wo, u0, u1, u2)) ++above;
            }
            // 4.5 binomial sigma (30 cases) beside the quadrature's 1e-3.
            EXPECT_NEAR(static_cast<double>(above) / count, integral,
                        4.5 * std::sqrt(integral * std::abs(1 - integral) / count) + 2e-3)
                << "alpha " << alpha << ", v " << v;
        }
}

// Samples in cells of equal (cos theta, phi) steps against the density integrated over each cell.
double histogram_p_value(const Bsdf& bsdf, const Vec3& wo) {
    constexpr int rows = 16;
    constexpr int columns = 32;
    constexpr int fine = 24;  // points a cell and axis
    constexpr int count = 200'000;
    std::vector<double> expected(rows * columns + 1, 0);
    std::vector<double> counts(rows * columns + 1, 0);
    double above = 0;
    for (int row = 0; row < rows * fine; ++row)
        for (int column = 0; column < columns * fine; ++column) {
            const double z = (row + 0.5) / (rows * fine);
            const double phi = 2 * pi_d * (column + 0.5) / (columns * fine);
            const double sine = std::sqrt(1 - z * z);
            const Vec3 wi = Vec3d(sine * std::cos(phi), sine * std::sin(phi), z).cast<float>();
            const double share = static_cast<double>(direction_pdf(bsdf, normal, wo, wi)) * 2 *
                                 pi_d / (rows * fine) / (columns * fine);
            expected[static_cast<std::size_t>(row / fine * columns + column / fine)] +=
                share * count;
            above += share;
        }
    expected.back() = std::max(0.0, 1 - above) * count;
    for (std::uint64_t i = 0; i < count; ++i) {
        Rng rng(3, Stage::test, i);
        const float u0 = rng.next();
        const float u1 = rng.next();
        const float u2 = rng.next();
        const auto wi = sample_direction(bsdf, normal, wo, u0, u1, u2);
        if (!wi) {
            ++counts.back();
            continue;
        }
        const double phi = std::atan2(static_cast<double>(wi->y()), static_cast<double>(wi->x()));
        const double turns = phi < 0 ? phi / (2 * pi_d) + 1 : phi / (2 * pi_d);
        const int row = std::min(rows - 1, static_cast<int>(wi->z() * rows));
        const int column = std::min(columns - 1, static_cast<int>(turns * columns));
        ++counts[static_cast<std::size_t>(row * columns + column)];
    }
    return support::chi_square_p_value(counts, expected);
}

TEST(Schlick, SamplesFollowTheirDensity) {
    // Down to 0.1: below, the lobe is narrower than a cell's quadrature points. Nine tests.
    for (const float alpha : {1.0F, 0.3F, 0.1F})
        for (const float v : cosines)
            EXPECT_GT(histogram_p_value(support::schlick(1, alpha), direction(v)), 1e-3 / 9)
                << "alpha " << alpha << ", v " << v;
}

TEST(Diffuse, SamplesFollowTheirDensity) {
    EXPECT_GT(histogram_p_value(support::diffuse(1), direction(0.6F)), 1e-3);
}

TEST(Schlick, IsReciprocal) {
    for (const float alpha : alphas)
        for (std::uint64_t i = 0; i < 1000; ++i) {
            Rng rng(4, Stage::test, i);
            const float u0 = rng.next();
            const float u1 = rng.next();
            const Vec3 a = cosine_hemisphere(u0, u1);
            const float u2 = rng.next();
            const float u3 = rng.next();
            const Vec3 b = cosine_hemisphere(u2, u3);
            const Bsdf bsdf = support::schlick(0.7F, alpha);
            const float ab = evaluate(bsdf, Vec2::Zero(), normal, a, b)[0];
            const float ba = evaluate(bsdf, Vec2::Zero(), normal, b, a)[0];
            EXPECT_NEAR(ab / ba, 1, 1e-5);
            EXPECT_GE(ab, 0);
        }
}

}  // namespace
}  // namespace caustics
