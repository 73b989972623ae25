#include "core/material/ior.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/material/optics.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

constexpr double one_degree = pi_d / 180;

Ior named(const std::string& name) {
    for (const NamedGlass& glass : named_glasses())
        if (glass.name == name) return Ior::sellmeier(glass.terms);
    throw std::logic_error("no glass " + name);
}

// The number that the catalogue prints beside the terms.
TEST(Ior, GlassesHaveTheIndexAndAbbeNumberOfTheirCatalogue) {
    for (const NamedGlass& glass : named_glasses()) {
        const Ior ior = Ior::sellmeier(glass.terms);
        EXPECT_NEAR(ior.at(587.5618F), glass.n_d,
                    1e-5 + 1e-4 * (glass.name == std::string("water")))
            << glass.name;
        const double v_d = (ior.at(587.5618F) - 1) / (ior.at(486.1327F) - ior.at(656.2725F));
        EXPECT_NEAR(v_d, glass.v_d, 0.05) << glass.name;
        EXPECT_FALSE(ior.why_unusable()) << glass.name;
    }
}

TEST(Ior, OfASurfaceIsTheRatioOfBothMediaAtTheWavelength) {
    const Dielectric gem{.int_ior = Ior::cauchy(1.6, 0.01), .ext_ior = 1.25F};
    for (const float nm : {400.0F, 500.0F, 700.0F}) {
        const double um = static_cast<double>(nm) / 1000;
        const double ratio = (1.6 + 0.01 / (um * um)) / 1.25;
        EXPECT_NEAR(gem.relative_ior(true, nm), ratio, 1e-6);
        EXPECT_NEAR(gem.relative_ior(false, nm), 1 / ratio, 1e-6);
    }
}

// Schott's table of refractive indices at spectral lines.
TEST(Ior, Bk7IsSchottsAtItsLines) {
    const Ior bk7 = named("bk7");
    EXPECT_NEAR(bk7.at(404.6561F), 1.53024, 1e-5);
    EXPECT_NEAR(bk7.at(435.8343F), 1.52668, 1e-5);
    EXPECT_NEAR(bk7.at(546.0740F), 1.51872, 1e-5);
    EXPECT_NEAR(bk7.at(632.8F), 1.51509, 1e-5);
    EXPECT_NEAR(bk7.at(706.5188F), 1.51289, 1e-5);
}

TEST(Ior, AbbesNumberGivesCauchysLaw) {
    const Ior lead = Ior::abbe(1.7, 30);
    EXPECT_NEAR(lead.at(587.5618F), 1.7, 1e-6);
    EXPECT_NEAR(lead.at(400), 1.741, 1e-3);
    EXPECT_NEAR(lead.at(700), 1.6895, 1e-3);
    EXPECT_EQ(Ior::cauchy(1.5, 0.004).at(500), 1.5 + 0.004 / 0.25);
}

TEST(Ior, ALawWithoutDispersionIsANumber) {
    EXPECT_FALSE(Ior::cauchy(1.5, 0).is_dispersive());
    EXPECT_TRUE(Ior::cauchy(1.5, 0) == Ior(1.5F));
    EXPECT_EQ(Ior::cauchy(1.5, 0).at(400), 1.5);
    EXPECT_FALSE(Ior::sellmeier({{1.25, 0}}).is_dispersive());
    EXPECT_TRUE(named("f2").is_dispersive());
    EXPECT_FALSE(named("f2") == named("sf5"));
}

// Between 380 and 780 nm: at least 1, at most 10, and finite. Lists of the law may hold terms of no weight.
TEST(Ior, TellsWhereALawIsNoIndex) {
    EXPECT_FALSE(Ior(40.0F).why_unusable()) << "a number is asked for its range by its key";
    EXPECT_FALSE(Ior::sellmeier({{1.25, 0.01}, {0, 0.25}}).why_unusable());
    EXPECT_EQ(Ior::sellmeier({{1.25, 0.01}, {0.5, 0.25}}).why_unusable(),
              "the index is infinite at 500 nm");
    EXPECT_EQ(Ior::sellmeier({{-1.25, 0}}).why_unusable(), "the index is not finite at 380 nm");
    EXPECT_EQ(Ior::cauchy(1.1, -0.0361).why_unusable(), "the index is 0.850000 at 380 nm, below 1");
    EXPECT_EQ(Ior::cauchy(9, 0.1805).why_unusable(), "the index is 10.250000 at 380 nm, above 10");
}

// Least deviation of a prism of 60 degrees: 2 asin(n / 2) - 60 degrees, by two refractions.
TEST(Ior, APrismTurnsItsColoursByAsMuchAsSnellSays) {
    Bsdf glass = support::glass(1.5F);
    std::get<Dielectric>(glass.model).int_ior = named("sf10");
    const double half = 30 * one_degree;
    const Vec3 first = Vec3d(-std::cos(half), 0, std::sin(half)).cast<float>();
    const Vec3 second = Vec3d(std::cos(half), 0, std::sin(half)).cast<float>();
    const struct {
        float nm;
        double deviation;
    } lines[] = {
        {404.6561F, 65.217}, {486.1327F, 61.676}, {587.5618F, 59.565}, {656.2725F, 58.728}};
    for (const auto& line : lines) {
        const double turn = line.deviation * one_degree / 2;
        const Vec3 in = Vec3d(std::cos(turn), 0, std::sin(turn)).cast<float>();
        const SpecularSplit entry = split_specular(glass, first, first, -in, line.nm);
        const SpecularSplit exit = split_specular(glass, second, second, -entry.refracted, line.nm);
        const double angle =
            std::acos(std::min(1.0, static_cast<double>(in.dot(exit.refracted)))) / one_degree;
        EXPECT_NEAR(angle, line.deviation, 5e-3) << line.nm;
    }
}

// Turn of a ray through a water sphere with `inner` reflections, by the events' own directions.
double rainbow_angle(float nm, int inner) {
    Bsdf water = support::glass(1.333F);
    std::get<Dielectric>(water.model).int_ior = named("water");
    double angle = inner == 1 ? 0 : 180;
    for (double height = 0.5; height < 0.999; height += 1e-4) {
        const Vec3d in(0, 0, -1);
        Vec3d place(height, 0, std::sqrt(1 - height * height));
        Vec3 direction = in.cast<float>();
        for (int event = 0; event < inner + 2; ++event) {
            const Vec3 n = place.cast<float>();
            const SpecularSplit split = split_specular(water, n, n, -direction, nm);
            const bool is_inside = event > 0 && event <= inner;
            direction = is_inside ? split.reflected : split.refracted;
            const Vec3d d = direction.cast<double>();
            place -= 2 * place.dot(d) * d;
        }
        const double back = std::acos(-direction.cast<double>().normalized().dot(in)) / one_degree;
        angle = inner == 1 ? std::max(angle, back) : std::min(angle, back);
    }
    return angle;
}

TEST(Ior, RainbowsStandWhereDescartesPutsThem) {
    EXPECT_NEAR(rainbow_angle(656, 1), 42.29, 0.02);
    EXPECT_NEAR(rainbow_angle(588, 1), 42.02, 0.02);
    EXPECT_NEAR(rainbow_angle(405, 1), 40.63, 0.02);
    EXPECT_NEAR(rainbow_angle(656, 2), 50.50, 0.02);
    EXPECT_NEAR(rainbow_angle(588, 2), 51.00, 0.02);
    EXPECT_NEAR(rainbow_angle(405, 2), 53.51, 0.02);
}

}  // namespace
}  // namespace caustics
