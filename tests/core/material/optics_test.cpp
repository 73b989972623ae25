#include "core/material/optics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"
#include "core/math/sampling.h"
#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"
#include "tests/support/random_direction.h"

namespace caustics {
namespace {

using support::random_direction;

Vec3 direction_at(double angle) { return Vec3d(std::sin(angle), 0, std::cos(angle)).cast<float>(); }

TEST(Optics, ReflectionMirrorsAboutTheNormal) {
    EXPECT_LT((reflect(direction_at(0.4), Vec3::UnitZ()) - direction_at(-0.4)).norm(), 1e-6F);
}

TEST(Optics, RefractionObeysSnellsLaw) {
    for (const double eta : {1.5, 1 / 1.5, 1.33, 2.4, 1.000001})
        for (double angle = 0; angle < 1.57; angle += 0.05) {
            const auto t = refract(direction_at(angle), Vec3::UnitZ(), static_cast<float>(eta));
            const double sine = std::sin(angle) / eta;
            if (std::abs(sine - 1) < 1e-4) continue;
            ASSERT_EQ(t.has_value(), sine < 1) << angle << " " << eta;
            if (!t) continue;
            EXPECT_NEAR(t->x(), -sine, 2e-6);
            EXPECT_LT(t->z(), 0);
            EXPECT_NEAR(t->norm(), 1, 1e-6F);
        }
}

TEST(Optics, RefractionIsReversible) {
    Rng rng(1, Stage::test, 0);
    const Vec3 n = Vec3::UnitZ();
    for (int i = 0; i < 1000; ++i) {
        const float u0 = rng.next();
        const Vec3 w = cosine_hemisphere(u0, rng.next());
        if (w.z() < 0.05F) continue;
        const auto t = refract(w, n, 1.5F);
        ASSERT_TRUE(t);
        const auto back = refract(*t, Vec3(-n), 1 / 1.5F);
        ASSERT_TRUE(back);
        EXPECT_LT((*back - w).norm(), 2e-5F) << w.transpose();
    }
}

TEST(Optics, EqualIndicesPassStraight) {
    const Vec3 w = direction_at(1.0);
    EXPECT_LT((*refract(w, Vec3::UnitZ(), 1) + w).norm(), 1e-6F);
    EXPECT_NEAR(fresnel_dielectric(w.z(), 1), 0, 1e-7F);
}

TEST(Optics, FresnelMatchesItsClosedForms) {
    for (const double n : {1.5, 1 / 1.5, 1.33, 2.4}) {
        const auto eta = static_cast<float>(n);
        EXPECT_NEAR(fresnel_dielectric(1, eta), std::pow((n - 1) / (n + 1), 2), 1e-6);
        // At Brewster's angle R_p vanishes and R_s = ((1 - n^2) / (1 + n^2))^2.
        const double brewster = std::atan(n);
        EXPECT_NEAR(fresnel_dielectric(static_cast<float>(std::cos(brewster)), eta),
                    0.5 * std::pow((1 - n * n) / (1 + n * n), 2), 2e-6);
        EXPECT_NEAR(fresnel_dielectric(0, eta), 1, 1e-6F);
        for (int i = 1; i <= 100; ++i) {
            const double cosine = i / 100.0;
            if (std::abs(1 - cosine * cosine - n * n) < 0.02) continue;  // the critical angle
            EXPECT_NEAR(fresnel_dielectric(static_cast<float>(cosine), eta),
                        support::fresnel(cosine, n), 5e-6)
                << cosine << " " << n;
        }
    }
    EXPECT_EQ(fresnel_dielectric(0.5F, 1 / 1.5F), 1.0F);
    EXPECT_FALSE(refract(direction_at(1.0), Vec3::UnitZ(), 1 / 1.5F));
}

TEST(Optics, FresnelIsTheSameFromBothSides) {
    for (int i = 1; i < 50; ++i) {
        const Vec3 w = direction_at(i * 0.03);
        const Vec3 t = *refract(w, Vec3::UnitZ(), 1.5F);
        EXPECT_NEAR(fresnel_dielectric(w.z(), 1.5F), fresnel_dielectric(-t.z(), 1 / 1.5F), 2e-5F);
    }
}

TEST(Optics, ASplitKeepsAllTheFlux) {
    Rng rng(2, Stage::test, 0);
    const Bsdf glass = support::glass(1.5F, 1.2F);
    for (int i = 0; i < 10'000; ++i) {
        const Vec3 n = random_direction(rng);
        const Vec3 w = random_direction(rng);
        const SpecularSplit split = split_specular(glass, n, n, w);
        EXPECT_NEAR((split.reflected_weight + split.refracted_weight)[1], 1, 1e-6F);
        EXPECT_NEAR(split.eta, n.dot(w) > 0 ? 1.5F / 1.2F : 1.2F / 1.5F, 1e-6F);
        EXPECT_GE(n.dot(w) * n.dot(split.reflected), 0);
        EXPECT_TRUE(split.refracted_weight[0] == 0 || n.dot(w) * n.dot(split.refracted) <= 0);
    }
}

// What a tilted shading normal drops is dropped for the reversed path too.
TEST(Optics, DirectionsOnTheWrongSideAreDroppedBothWays) {
    Rng rng(3, Stage::test, 0);
    const Vec3 ng = Vec3::UnitZ();
    int dropped = 0;
    for (const Bsdf& bsdf : {support::glass(1.5F), support::mirror()})
        for (int i = 0; i < 20'000; ++i) {
            const Vec3 ns = Vec3(rng.next() - 0.5F, rng.next() - 0.5F, 0.5F).normalized();
            const Vec3 w = random_direction(rng);
            const SpecularSplit split = split_specular(bsdf, ng, ns, w);
            const bool wrong_side = (ng.dot(w) > 0) != (ns.dot(w) > 0);
            if (wrong_side) {
                EXPECT_TRUE(is_black(split.reflected_weight) && is_black(split.refracted_weight));
                continue;
            }
            const float margin = 1e-4F;
            if (std::abs(ng.dot(split.reflected)) < margin) continue;
            dropped += is_black(split.reflected_weight) ? 1 : 0;
            const SpecularSplit back = split_specular(bsdf, ng, ns, split.reflected);
            if (is_black(split.reflected_weight)) {
                EXPECT_TRUE((back.reflected - w).norm() > 1e-3F || is_black(back.reflected_weight));
            } else {
                EXPECT_LT((back.reflected - w).norm(), 1e-5F);
                // From inside, the reflectance is infinitely steep at the critical angle.
                if (ng.dot(w) > 0) {
                    EXPECT_NEAR(back.reflected_weight[0], split.reflected_weight[0], 1e-5F);
                }
            }
        }
    EXPECT_GT(dropped, 100);
}

TEST(Optics, AOneSidedMirrorIsBlackBehind) {
    Bsdf mirror = support::mirror(0.9F);
    const Vec3 n = Vec3::UnitZ();
    EXPECT_FLOAT_EQ(split_specular(mirror, n, n, -direction_at(0.3)).reflected_weight[0], 0.9F);
    mirror.twosided = false;
    EXPECT_FLOAT_EQ(split_specular(mirror, n, n, direction_at(0.3)).reflected_weight[0], 0.9F);
    EXPECT_TRUE(is_black(split_specular(mirror, n, n, -direction_at(0.3)).reflected_weight));
    const SpecularSplit none = split_specular(support::diffuse(0.5F), n, n, direction_at(0.3));
    EXPECT_TRUE(is_black(none.reflected_weight) && is_black(none.refracted_weight));
}

TEST(Optics, BeersLaw) {
    const Spectrum left = transmittance(Spectrum(0, 1, 2.5F), 0.4F);
    EXPECT_FLOAT_EQ(left[0], 1);
    EXPECT_FLOAT_EQ(left[1], std::exp(-0.4F));
    EXPECT_FLOAT_EQ(left[2], std::exp(-1.0F));
}

TEST(Optics, TheMediumIsTheOneWhereTheSegmentEnds) {
    const Spectrum inside(1, 2, 3), outside(4, 5, 6);
    const Bsdf glass = support::glass(1.5F, 1, inside, outside);
    const Vec3 n = Vec3::UnitZ();
    EXPECT_TRUE((*medium_absorption(glass, n, n) == outside).all());
    EXPECT_TRUE((*medium_absorption(glass, n, -n) == inside).all());
    EXPECT_FALSE(medium_absorption(support::mirror(), n, n));
    EXPECT_FALSE(medium_absorption(support::diffuse(0.5F), n, n));
    const Spectrum end = segment_transmittance(&inside, &outside, 0.1F);
    EXPECT_FLOAT_EQ(end[0], std::exp(-0.4F));
    EXPECT_FLOAT_EQ(segment_transmittance(&inside, nullptr, 0.1F)[0], std::exp(-0.1F));
    EXPECT_EQ(segment_transmittance(nullptr, nullptr, 0.1F)[0], 1);
    // A lossless end wins over an absorbing start.
    const Spectrum none = black();
    EXPECT_EQ(segment_transmittance(&inside, &none, 0.1F)[0], 1);
}

}  // namespace
}  // namespace caustics
