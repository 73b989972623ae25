#include "core/material/bsdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"

#include "core/math/frame.h"
#include "core/math/rng.h"
#include "core/math/sampling.h"
#include "core/render/film.h"
#include "tests/support/build_scene.h"
#include "tests/support/statistics.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

Vec3 polar(double cosine, double azimuth) {
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return Vec3d(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine).cast<float>();
}

// Integral over a cell of (cos, azimuth) by a fine midpoint rule.
template <typename Function>
double integrate(double c0, double c1, double a0, double a1, int steps, const Function& f) {
    double sum = 0;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j)
            sum += static_cast<double>(
                f(polar(c0 + (c1 - c0) * (i + 0.5) / steps, a0 + (a1 - a0) * (j + 0.5) / steps)));
    return sum * (c1 - c0) * (a1 - a0) / (steps * steps);
}

// Counts of sampled directions by cell against the integrals of direction_pdf. Directions are
// sorted by a frame about the mirror direction, where narrow lobes are resolved.
double sampling_p_value(const Bsdf& bsdf, const Vec3& n, const Vec3& wo, std::uint64_t seed) {
    constexpr int rows = 16, columns = 12, draws = 100'000;
    const Frame about(Vec3(2 * n.dot(wo) * n - wo).normalized());
    // Rows are even in sqrt(1 - cos), so that they crowd at the lobe's centre.
    const auto edge = [](int row) { return 1 - 2 * std::pow(double(row) / rows, 4.0); };
    std::vector<double> counts(rows * columns + 1), expected(rows * columns + 1);
    Rng rng(seed, Stage::test, 0);
    for (int i = 0; i < draws; ++i) {
        const float u0 = rng.next(), u1 = rng.next(), u2 = rng.next();
        const auto wi = sample_direction(bsdf, n, wo, u0, u1, u2);
        if (!wi) {
            counts.back() += 1;
            continue;
        }
        EXPECT_NEAR(wi->norm(), 1, 1e-5F);
        const Vec3 local = about.to_local(*wi);
        const double share = std::pow(std::max(0.0, 1 - static_cast<double>(local.z())) / 2, 0.25);
        const int row = std::clamp(static_cast<int>(share * rows), 0, rows - 1);
        const double turn =
            std::atan2(static_cast<double>(local.y()), static_cast<double>(local.x()));
        const int column =
            std::clamp(static_cast<int>((turn / (2 * pi_d) + 0.5) * columns), 0, columns - 1);
        counts[static_cast<std::size_t>(row * columns + column)] += 1;
    }
    double inside = 0;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const auto azimuth = [](int at) { return (double(at) / columns - 0.5) * 2 * pi_d; };
            const double share =
                integrate(edge(row + 1), edge(row), azimuth(column), azimuth(column + 1), 40,
                          [&](const Vec3& local) {
                              return direction_pdf(bsdf, n, wo, about.to_world(local).normalized());
                          });
            expected[static_cast<std::size_t>(row * columns + column)] = draws * share;
            inside += share;
        }
    EXPECT_LT(inside, 1.003);
    expected.back() = std::max(0.0, draws * (1 - inside));
    return support::chi_square_p_value(counts, expected);
}

TEST(Bsdf, SamplesFollowTheirDensity) {
    const Vec3 n = Vec3(0.3F, -0.2F, 0.9F).normalized();
    const Frame frame(n);
    std::uint64_t seed = 1;
    for (const double cosine : {1.0, 0.7, 0.2}) {
        const Vec3 wo = frame.to_world(polar(cosine, 0.6)).normalized();
        EXPECT_GT(sampling_p_value(support::diffuse(0.5F), n, wo, seed++), 1e-4) << cosine;
        for (const float alpha : {1.0F, 0.5F, 0.1F, 0.01F})
            EXPECT_GT(sampling_p_value(support::schlick(0.5F, alpha), n, wo, seed++), 1e-4)
                << cosine << " alpha " << alpha;
        for (const float exponent : {0.0F, 2.5F, 30.0F, 1000.0F})
            EXPECT_GT(sampling_p_value(support::phong(0.3F, 0.5F, exponent), n, wo, seed++), 1e-4)
                << cosine << " exponent " << exponent;
    }
}

// Reflectance of light from wo, by samples.
support::Moments albedo_of(const Bsdf& bsdf, const Vec3& wo, std::uint64_t seed = 11) {
    support::Moments moments;
    Rng rng(seed, Stage::test, 0);
    for (int i = 0; i < 100'000; ++i) {
        const float u0 = rng.next(), u1 = rng.next(), u2 = rng.next();
        const auto wi = sample_direction(bsdf, Vec3::UnitZ(), wo, u0, u1, u2);
        moments.add(
            wi ? static_cast<double>(evaluate(bsdf, Vec2::Zero(), Vec3::UnitZ(), wo, *wi)[0] *
                                     wi->z() / direction_pdf(bsdf, Vec3::UnitZ(), wo, *wi))
               : 0.0);
    }
    return moments;
}

// k_d + k_s straight on, where the lobe's integral is whole, and no more elsewhere.
TEST(Bsdf, PhongReflectsItsReflectancesStraightOnAndNoMoreElsewhere) {
    for (const float exponent : {0.0F, 1.0F, 30.0F, 500.0F}) {
        const Bsdf bsdf = support::phong(0.3F, 0.6F, exponent);
        for (const double v : {1.0, 0.8, 0.4, 0.05}) {
            const support::Moments found = albedo_of(bsdf, polar(v, 0.3));
            EXPECT_LT(found.mean(), 0.9 + 4 * found.standard_error() + 1e-6)
                << exponent << " " << v;
            if (v == 1) {
                EXPECT_NEAR(found.mean(), 0.9, 4 * found.standard_error() + 1e-6) << exponent;
            }
        }
        EXPECT_NEAR(albedo(bsdf, Vec2::Zero())[1], 0.9F, 1e-6F);
    }
}

// The law of 1975: what arrives shines without its cosine, about the mirror direction.
TEST(Bsdf, ClassicPhongHasNoCosineOfArrival) {
    const Bsdf bsdf = support::phong(0.3F, 0.6F, 20, Phong::Model::classic);
    const Vec3 n = Vec3::UnitZ();
    for (const double v : {0.9, 0.5, 0.2}) {
        const Vec3 wo = polar(v, 0.4);
        const Vec3 wi = polar(v, 0.4 + pi_d);
        EXPECT_NEAR(evaluate(bsdf, Vec2::Zero(), n, wo, wi)[0] * wi.z(),
                    0.3F / pi * static_cast<float>(v) + 0.6F, 1e-4F);
        const double away = 0.2;
        const Vec3 aside = polar(std::cos(std::acos(v) + away), 0.4 + pi_d);
        if (!(aside.z() > 0)) continue;
        EXPECT_NEAR(evaluate(bsdf, Vec2::Zero(), n, wo, aside)[0] * aside.z(),
                    0.3F / pi * aside.z() + 0.6F * static_cast<float>(std::pow(std::cos(away), 20)),
                    1e-4F);
    }
}

// f_r cos / pdf averaged over samples is the albedo, for which alpha = 1 has a closed form.
TEST(Bsdf, SampledAlbedoOfSchlickAtAlphaOneIsTheClosedForm) {
    const Bsdf bsdf = support::schlick(1, 1);
    for (const double v : {1.0, 0.6, 0.2}) {
        const support::Moments moments = albedo_of(bsdf, polar(v, 0.3), 5);
        EXPECT_NEAR(moments.mean(), 1.25 - 2 * v / 3, 4 * moments.standard_error() + 1e-6) << v;
    }
}

TEST(Bsdf, IsReciprocalAndBlackBelow) {
    Rng rng(7, Stage::test, 0);
    const Vec3 n = Vec3::UnitZ();
    for (const Bsdf& bsdf : {support::schlick(0.8F, 1), support::schlick(0.8F, 0.3F),
                             support::schlick(0.8F, 0.01F), support::phong(0.4F, 0.5F, 40)}) {
        for (int i = 0; i < 1000; ++i) {
            const float u0 = rng.next(), u1 = rng.next(), u2 = rng.next(), u3 = rng.next();
            const Vec3 a = cosine_hemisphere(u0, u1), b = cosine_hemisphere(u2, u3);
            const float ab = evaluate(bsdf, Vec2::Zero(), n, a, b)[0];
            EXPECT_NEAR(ab, evaluate(bsdf, Vec2::Zero(), n, b, a)[0], 1e-5F * (1 + ab));
            EXPECT_GE(ab, 0);
            EXPECT_TRUE(is_black(evaluate(bsdf, Vec2::Zero(), n, a, -b)));
            EXPECT_TRUE(is_black(evaluate(bsdf, Vec2::Zero(), n, -a, b)));
            EXPECT_EQ(direction_pdf(bsdf, n, a, -b), 0);
        }
    }
}

TEST(Bsdf, GrazingOppositeDirectionsStayFinite) {
    for (const float alpha : {1.0F, 0.1F, 0.01F}) {
        const Bsdf bsdf = support::schlick(0.8F, alpha);
        for (float z = 1e-1F; z > 1e-9F; z *= 0.7F)
            for (int i = 0; i < 200; ++i) {
                const Vec3 across = polar(0, i * 0.1);
                // Not normalised on purpose: unit to rounding only, as rays are.
                const Vec3 wo = across + z * Vec3::UnitZ();
                const Vec3 wi =
                    -across * (1 + static_cast<float>(i % 3 - 1) * 1e-7F) + z * Vec3::UnitZ();
                EXPECT_TRUE(is_finite(evaluate(bsdf, Vec2::Zero(), Vec3::UnitZ(), wo, wi)));
                const float pdf = direction_pdf(bsdf, Vec3::UnitZ(), wo, wi);
                EXPECT_TRUE(std::isfinite(pdf) && pdf >= 0) << z << " " << pdf;
            }
    }
}

TEST(Bsdf, AMirrorPartTakesItsWeightFromTheRest) {
    const Vec3 up = Vec3::UnitZ();
    const Vec3 wi = Vec3(0.6F, 0, 0.8F);
    for (Bsdf bsdf :
         {support::diffuse(0.5F), support::schlick(0.8F, 0.1F), support::phong(0.4F, 0.5F, 9)}) {
        const Spectrum alone = evaluate(bsdf, Vec2::Zero(), up, up, wi);
        const Spectrum all = albedo(bsdf, Vec2::Zero());
        bsdf.mirror = MirrorPart{0.25F, Spectrum(Spectrum::Constant(0.9F))};
        EXPECT_LT((evaluate(bsdf, Vec2::Zero(), up, up, wi) - 0.75F * alone).abs().maxCoeff(),
                  1e-6F);
        EXPECT_LT((albedo(bsdf, Vec2::Zero()) - 0.75F * all).abs().maxCoeff(), 1e-6F);
    }
}

TEST(Bsdf, AtAPlaceAnswersWithTheTexturesValuesThere) {
    const Checkerboard board{Spectrum(0.1F, 0.2F, 0.3F), Spectrum(0.4F, 0.1F, 0.2F)};
    Phong phong;
    phong.diffuse_reflectance = board;
    phong.exponent = 7;
    phong.model = Phong::Model::classic;
    const std::vector<Bsdf> all = {
        {Diffuse{board}}, {Schlick{board, 0.3F}, true}, {phong, false, MirrorPart{0.25F}}};
    const Vec3 n = Vec3::UnitZ(), wo = polar(0.7, 0), wi = polar(0.5, 2.5);
    for (const Bsdf& bsdf : all)
        for (const Vec2& uv : {Vec2(0.2F, 0.3F), Vec2(0.7F, 0.3F)}) {
            const Bsdf at = bsdf_at(bsdf, uv);
            EXPECT_EQ(at.twosided, bsdf.twosided);
            EXPECT_TRUE(
                (evaluate(at, Vec2(9, 8), n, wo, wi) == evaluate(bsdf, uv, n, wo, wi)).all());
            EXPECT_TRUE((albedo(at, Vec2(9, 8)) == albedo(bsdf, uv)).all());
        }
    const Bsdf glass = support::glass(1.5F);
    EXPECT_TRUE(is_caster(bsdf_at(glass, Vec2::Zero())));
}

TEST(Bsdf, WhatScattersInOneDirectionOnlyHasNoDensity) {
    const Vec3 up = Vec3::UnitZ();
    for (const Bsdf& bsdf : {support::glass(1.5F), support::mirror()})
        EXPECT_EQ(direction_pdf(bsdf, up, up, Vec3(0.6F, 0, 0.8F)), 0);
}

TEST(Bsdf, CastersReceiversAndSides) {
    EXPECT_TRUE(is_caster(support::glass(1.5F)) && is_caster(support::mirror()));
    EXPECT_TRUE(is_receiver(support::diffuse(1)) && is_receiver(support::schlick(1, 0.5F)));
    EXPECT_TRUE(is_receiver(support::phong(0.5F, 0.5F, 3)));
    EXPECT_TRUE(scatters_from(support::glass(1.5F), false));
    EXPECT_FALSE(scatters_from(support::diffuse(1), false));
    EXPECT_TRUE(scatters_from(support::diffuse(1, true), false));
    EXPECT_FLOAT_EQ(albedo(support::diffuse(0.25F), Vec2::Zero())[2], 0.25F);
    EXPECT_EQ(albedo(support::mirror(0.5F), Vec2::Zero())[0], 1);
}

// Two squares of a bitmap, of 0.3 and 0.6.
Bitmap two_texels() {
    Bitmap bitmap;
    bitmap.width = 2;
    bitmap.height = 1;
    bitmap.texels = {Spectrum::Constant(0.3F), Spectrum::Constant(0.6F)};
    return bitmap;
}

TEST(Phong, SendsAsMuchToItsLobeAsItsBrightestPlacesSay) {
    scene_file::Assets assets;
    const auto read = [&](const std::string& keys) {
        return Phong::read(JsonNode::parse_text(R"({"type": "phong", )" + keys + "}", "test"),
                           assets);
    };
    EXPECT_FLOAT_EQ(read(R"("diffuse_reflectance": 0.6, "specular_reflectance": 0.3)").lobe_share,
                    1.0F / 3);
    EXPECT_FLOAT_EQ(read(R"("diffuse_reflectance": 0, "specular_reflectance": 0)").lobe_share,
                    0.5F);
    const std::string board =
        R"({"type": "checkerboard", "color0": 0.1, "color1": 0.6, "to_uv": []})";
    EXPECT_FLOAT_EQ(
        read(R"("specular_reflectance": 0.2, "diffuse_reflectance": )" + board).lobe_share, 0.25F);
    EXPECT_THROW(read(R"("diffuse_reflectance": 0.5, "specular_reflectance": )" + board),
                 InputError)
        << "1.1 where the board is brightest";
}

TEST(Phong, SendsAsMuchToItsLobeAsTheBrightestTexelSays) {
    const support::TemporaryFolder folder;
    const auto read = [&](const std::string& picture, unsigned char dark, unsigned char bright) {
        write_png(2, 1, {dark, dark, dark, dark, bright, dark}, folder / picture);
        const std::string text = R"({"type": "phong", "specular_reflectance": 0.2,
            "diffuse_reflectance": {"type": "bitmap", "raw": true, "filename": ")" +
                                 picture + "\"}}";
        scene_file::Assets assets;
        return Phong::read(JsonNode::parse_text(text, "test", folder / "scene.json"), assets);
    };
    // 51 and 153 of 255 are 0.2 and 0.6.
    EXPECT_FLOAT_EQ(read("a.png", 51, 153).lobe_share, 0.25F);
    EXPECT_FLOAT_EQ(read("b.png", 51, 51).lobe_share, 0.5F);
    EXPECT_THROW(read("c.png", 51, 255), InputError) << "1.2 at one texel";
}

TEST(Phong, AHighlightForPovRayIsOfTheOldModelAndOfOneStrength) {
    Phong phong{.specular_reflectance = Spectrum(Spectrum::Constant(0.2F)), .exponent = 40};
    EXPECT_NE(phong.to_povray().refused.reason.find("\"classic\""), std::string::npos);
    phong.model = Phong::Model::classic;
    EXPECT_EQ(phong.to_povray().refused.reason, "");
    EXPECT_EQ(phong.to_povray().highlight, fmt::format(" phong {} phong_size 40", pi * 0.2F));
    for (const Texture& texture : {Texture(two_texels()), Texture(Spectrum(0.2F, 0.2F, 0.1F))}) {
        phong.specular_reflectance = texture;
        EXPECT_NE(phong.to_povray().refused.reason.find("one strength"), std::string::npos);
    }
}

// Mitsuba has no medium in its dielectric, POV-Ray none outside and no share that is lost at the surface.
TEST(Dielectric, SaysWhatOtherProgramsDoNotTake) {
    Dielectric glass{.int_ior = 1.5F, .ext_ior = 1.0F};
    EXPECT_EQ(glass.to_mitsuba().refused.reason, "");
    EXPECT_EQ(glass.to_povray().refused.reason, "");
    EXPECT_FLOAT_EQ(static_cast<float>(glass.to_povray().interior->ior), 1.5F);
    const auto changed = [&](auto Dielectric::* member) {
        Dielectric other = glass;
        other.*member = Spectrum(1, 0.5F, 1);
        return other;
    };
    const Dielectric inside = changed(&Dielectric::absorption);
    EXPECT_NE(inside.to_mitsuba().refused.reason.find("does not absorb"), std::string::npos);
    EXPECT_EQ(inside.to_povray().refused.reason, "");
    const Dielectric outside = changed(&Dielectric::ext_absorption);
    EXPECT_NE(outside.to_mitsuba().refused.reason.find("does not absorb"), std::string::npos);
    EXPECT_NE(outside.to_povray().refused.reason.find("no absorption outside"), std::string::npos);
    for (const Dielectric& lossy : {changed(&Dielectric::specular_reflectance),
                                    changed(&Dielectric::specular_transmittance)}) {
        EXPECT_EQ(lossy.to_mitsuba().refused.reason, "");
        EXPECT_NE(lossy.to_povray().refused.reason.find("leave them 1"), std::string::npos);
    }
}

// POV-Ray's dispersion is the index of violet over that of red, at 400 and 700 nm here.
TEST(Dielectric, ItsDispersionIsAQuotientForPovRayAndRefusedForMitsuba) {
    const Dielectric glass{.int_ior = Ior::cauchy(1.5, 0.01), .ext_ior = 1.0F};
    EXPECT_NEAR(glass.to_povray().interior->dispersion.value_or(0),
                (1.5 + 0.01 / 0.16) / (1.5 + 0.01 / 0.49), 1e-7);
    EXPECT_NE(glass.to_mitsuba().refused.reason.find("no dispersion"), std::string::npos);
}

// The angle at which cos^e is a half.
TEST(Phong, TellsHowNarrowItsLobeIs) {
    Phong phong{.exponent = 2};
    EXPECT_NEAR(*phong.lobe_half_width(), pi / 4, 1e-6);
    phong.lobe_share = 0;
    EXPECT_FALSE(phong.lobe_half_width()) << "no lobe";
    EXPECT_FALSE((Phong{.exponent = 1e-3F}.lobe_half_width())) << "as wide as all directions";
}

}  // namespace
}  // namespace caustics
