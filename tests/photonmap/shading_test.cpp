#include "photonmap/estimate/shading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "photonmap/kernels/cosine_power.h"
#include "photonmap/kernels/simd_plain.h"
#include "shading_sets.h"

namespace caustics::photonmap {
namespace {

using test::PhotonArrays;

const Spectrum grey_red(0.9F, 0.5F, 0.25F);

Bsdf lambert() { return {Diffuse{grey_red}}; }
Bsdf schlick(float alpha) { return {Schlick{grey_red, alpha}}; }

/// Phong's law with the colours of grey_red, half and half.
Bsdf phong(float exponent) {
    return {Phong{
        .diffuse_reflectance = Spectrum(0.5F * grey_red),
        .specular_reflectance = Spectrum(0.5F * grey_red),
        .exponent = exponent,
    }};
}

Bsdf classic_phong(float exponent) {
    Bsdf bsdf = phong(exponent);
    std::get<Phong>(bsdf.model).model = Phong::Model::classic;
    return bsdf;
}

double phong_as_printed(const Phong& phong, const Vec3d& n, const Vec3d& wo, const Vec3d& wi) {
    const auto exponent = static_cast<double>(phong.exponent);
    const double cosine = (2 * n.dot(wo) * n - wo).dot(wi);
    const double factor =
        phong.model == Phong::Model::normalised ? (exponent + 2) / (2 * pi_d) : 1 / n.dot(wi);
    return 0.5 / pi_d + 0.5 * factor * (cosine > 0 ? std::pow(cosine, exponent) : 0);
}

/// f_r over grey_red.
double reflection_as_printed(const Bsdf& bsdf, const Vec3d& n, const Vec3d& wo, const Vec3d& wi) {
    if (const auto* schlick = std::get_if<Schlick>(&bsdf.model))
        return test::schlick_as_printed(static_cast<double>(schlick->alpha), n, wo, wi);
    if (const auto* phong = std::get_if<Phong>(&bsdf.model))
        return phong_as_printed(*phong, n, wo, wi);
    return 1 / pi_d;
}

/// What each photon's flux is multiplied by, in double; which photons count at all is as
/// evaluate() decides it.
SpectrumSum oracle(const ReceiverPoint& point, const PhotonArrays& photons, bool weighted,
                   std::size_t left_out) {
    const Vec3d n = point.shading_normal.cast<double>().normalized();
    const Vec3d wo = point.wo.cast<double>().normalized();
    SpectrumSum sum = SpectrumSum::Zero();
    for (std::size_t i = 0; i < photons.size(); ++i) {
        const DirectionCode code = photons.direction(i);
        const Vec3 wi = decode_direction(code.theta, code.phi);
        if (i == left_out || point.shading_normal.dot(wi) <= 0) continue;
        const double reflection =
            reflection_as_printed(*point.bsdf, n, wo, wi.cast<double>().normalized());
        const double weight = weighted ? static_cast<double>(photons.weight(i)) : 1.0;
        sum += decode_rgbe(photons.energy(i)).cast<double>() * reflection * weight;
    }
    return sum * grey_red.cast<double>();
}

void expect_close(const SpectrumSum& value, const SpectrumSum& truth, const std::string& what) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], truth[c], 1e-5 * truth[c]) << what << c;
}

TEST(Shading, IsTheFormulaOnEveryInstructionSet) {
    Rng rng(31, Stage::test, 0);
    for (const float alpha : {0.0F, 1.0F, 0.5F, 0.1F, 0.01F, 0.001F}) {
        const Bsdf bsdf = alpha > 0 ? schlick(alpha) : lambert();
        for (const std::size_t count :
             {0U, 1U, 7U, 8U, 9U, 15U, 16U, 17U, 31U, 100U, 511U, 512U, 513U, 1500U}) {
            const ReceiverPoint point = test::random_point(rng, bsdf);
            const PhotonArrays photons = test::random_photons(count, 32);
            for (const bool weighted : {false, true}) {
                const std::size_t left_out = weighted ? count / 2 : WeightedPhotons::none;
                const SpectrumSum truth = oracle(point, photons, weighted, left_out);
                for (const Isa isa : supported_isas())
                    expect_close(Shading(isa).reflected(point, photons.photons(weighted, left_out)),
                                 truth,
                                 name(isa) + std::string(" ") + std::to_string(alpha) + " " +
                                     std::to_string(count) + " channel ");
                BrdfLobeTable table;
                expect_close(Shading(Isa::plain)
                                 .reflected(point, photons.photons(weighted, left_out), table),
                             truth, "table ");
            }
        }
    }
}

// The direction of a photon is known to a float's rounding, which a lobe of exponent e makes e times larger.
TEST(Shading, IsPhongsLawOnEveryInstructionSet) {
    Rng rng(45, Stage::test, 0);
    for (const float exponent : {0.0F, 0.5F, 1.0F, 7.3F, 30.0F, 200.0F, 5000.0F, 1e6F}) {
        const Bsdf bsdf = phong(exponent);
        const double tolerance = 1e-5 * std::max(1.0, 0.02 * static_cast<double>(exponent));
        for (const std::size_t count : {1U, 16U, 17U, 513U, 1500U}) {
            const ReceiverPoint point = test::random_point(rng, bsdf);
            PhotonArrays photons = test::random_photons(count, 46);
            const Vec3 mirrored =
                2 * point.shading_normal.dot(point.wo) * point.shading_normal - point.wo;
            // Half of them in the lobe, where it is narrow.
            for (std::size_t i = 0; i < count; i += 2) {
                const float width = 1 / std::sqrt(1 + exponent);
                const Vec3 near = mirrored + width * test::random_direction(rng);
                photons.set(i, photons.energy(i), encode_direction(near.normalized()),
                            photons.weight(i));
            }
            const SpectrumSum truth = oracle(point, photons, true, count / 2);
            const auto expect_near = [&](const SpectrumSum& found, const std::string& what) {
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(found[c], truth[c], tolerance * truth[c])
                        << what << " " << exponent << " " << count;
            };
            for (const Isa isa : supported_isas())
                expect_near(Shading(isa).reflected(point, photons.photons(true, count / 2)),
                            name(isa));
            BrdfLobeTable table;
            expect_near(
                Shading(Isa::plain).reflected(point, photons.photons(true, count / 2), table),
                "table");
        }
    }
}

TEST(Shading, IsTheSameBitsOnEveryInstructionSet) {
    Rng rng(47, Stage::test, 0);
    for (const Bsdf& bsdf : {lambert(), schlick(1), schlick(0.01F), phong(0.5F), phong(200)}) {
        for (const std::size_t count : {1U, 7U, 8U, 9U, 16U, 17U, 25U, 100U, 513U, 1500U}) {
            ReceiverPoint point = test::random_point(rng, bsdf);
            const PhotonArrays photons = test::random_photons(count, 48);
            for (const bool of_mesh : {false, true}) {
                if (of_mesh) point.geometric_normal = test::random_direction(rng);
                const auto given = photons.photons(true, count / 3);
                const SpectrumSum plain = Shading(Isa::plain).reflected(point, given);
                for (const Isa isa : supported_isas())
                    EXPECT_TRUE((Shading(isa).reflected(point, given) == plain).all())
                        << name(isa) << " " << count;
            }
        }
    }
}

TEST(Shading, RaisesCosinesToPowers) {
    for (const float exponent : {0.0F, 0.3F, 1.0F, 30.0F, 1000.0F, 1e6F})
        for (float t = 1e-9F; t < 1.2F; t = t * 1.37F + 1e-9F) {
            const double truth =
                t < 1
                    ? std::exp(static_cast<double>(exponent) * std::log1p(-static_cast<double>(t)))
                    : 0;
            EXPECT_NEAR(static_cast<double>(cosine_power<PlainSimd>(t, exponent)), truth,
                        3e-5 * truth + 1e-37)
                << exponent << " " << t;
        }
    EXPECT_EQ(cosine_power<PlainSimd>(0, 1e6F), 1);
}

TEST(Shading, IsTheFormulaWhereTheLobeIsSharpest) {
    // Seen near the mirror direction, along the normal and at grazing angles.
    const Bsdf bsdf = schlick(0.01F);
    Rng rng(33, Stage::test, 0);
    for (const double degrees : {0.0, 1e-6, 0.01, 1.0, 45.0, 80.0, 89.9}) {
        ReceiverPoint point = test::random_point(rng, bsdf);
        const Vec3d n = point.shading_normal.cast<double>();
        const double angle = degrees * pi_d / 180;
        point.wo = (n * std::cos(angle) + n.unitOrthogonal() * std::sin(angle)).cast<float>();
        const Vec3 mirrored =
            2 * point.shading_normal.dot(point.wo) * point.shading_normal - point.wo;
        PhotonArrays photons(64);
        for (std::size_t i = 0; i < photons.size(); ++i) {
            const Vec3 near = mirrored + 0.05F * test::random_direction(rng);
            photons.set(i, encode_rgbe(Spectrum::Ones()), encode_direction(near.normalized()));
        }
        const SpectrumSum truth = oracle(point, photons, false, WeightedPhotons::none);
        for (const Isa isa : supported_isas())
            expect_close(Shading(isa).reflected(point, photons.photons()), truth,
                         name(isa) + std::string(" ") + std::to_string(degrees) + " channel ");
    }
}

TEST(Shading, CountsThePhotonsThatEvaluateCountsForEveryDirectionCode) {
    const Bsdf bsdf = lambert();
    Rng rng(34, Stage::test, 0);
    PhotonArrays all(65'536);
    for (std::size_t code = 0; code < all.size(); ++code)
        all.set(code, encode_rgbe(Spectrum::Ones()),
                {static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(code >> 8U)});
    for (int trial = 0; trial < 30; ++trial) {
        ReceiverPoint point = test::random_point(rng, bsdf);
        // Normals along the axes put whole circles of directions at rounding's mercy.
        if (trial < 3) point.shading_normal = point.wo = Vec3::Unit(trial);
        double counted = 0;
        for (std::size_t code = 0; code < all.size(); ++code) {
            const Vec3 wi = decode_direction(all.direction(code).theta, all.direction(code).phi);
            if (!is_black(evaluate(bsdf, point.uv, point.shading_normal, point.wo, wi)))
                counted += 1;
        }
        for (const Isa isa : supported_isas()) {
            const SpectrumSum sum = Shading(isa).reflected(point, all.photons());
            EXPECT_NEAR(sum[0] * pi_d / static_cast<double>(grey_red[0]), counted, 0.01)
                << name(isa) << " trial " << trial;
        }
    }
}

TEST(Shading, IsBlackFromBelow) {
    Rng rng(35, Stage::test, 0);
    const PhotonArrays photons = test::random_photons(100, 36);
    for (const Bsdf& bsdf : {lambert(), schlick(0.1F), phong(30)}) {
        ReceiverPoint point = test::random_point(rng, bsdf);
        point.wo = -point.wo;
        BrdfLobeTable table;
        for (const Isa isa : supported_isas()) {
            EXPECT_TRUE((Shading(isa).reflected(point, photons.photons()) == 0).all());
            EXPECT_TRUE((Shading(isa).reflected(point, photons.photons(), table) == 0).all());
        }
    }
}

TEST(Shading, DecodesEveryEnergyExactly) {
    for (int exponent = 0; exponent < 255; ++exponent) {
        PhotonArrays photons(1);
        const Rgbe energy{{255, 1, static_cast<std::uint8_t>(exponent)},
                          static_cast<std::uint8_t>(exponent)};
        photons.set(0, energy, {});
        const SpectrumSum truth = decode_rgbe(energy).cast<double>();
        for (const Isa isa : supported_isas())
            EXPECT_TRUE((Shading(isa).arriving(photons.photons()) == truth).all())
                << name(isa) << " " << exponent;
    }
}

TEST(Shading, ArrivingLeavesOutAndWeighs) {
    const PhotonArrays photons = test::random_photons(700, 37);
    for (const std::size_t left_out : {0U, 3U, 16U, 511U, 512U, 513U, 699U}) {
        SpectrumSum truth = SpectrumSum::Zero();
        for (std::size_t i = 0; i < photons.size(); ++i)
            if (i != left_out)
                truth += (decode_rgbe(photons.energy(i)) * photons.weight(i)).cast<double>();
        for (const Isa isa : supported_isas())
            expect_close(Shading(isa).arriving(photons.photons(true, left_out)), truth, name(isa));
    }
}

// The mirror in a blend has its weight, the rest has what is left.
TEST(Shading, AMirrorPartLeavesTheRestItsShare) {
    Rng rng(49, Stage::test, 0);
    const PhotonArrays photons = test::random_photons(100, 50);
    for (Bsdf bsdf : {lambert(), schlick(0.3F), phong(7), classic_phong(7)}) {
        const ReceiverPoint point = test::random_point(rng, bsdf);
        const SpectrumSum alone = Shading(Isa::plain).reflected(point, photons.photons());
        bsdf.mirror = MirrorPart{0.25F, Spectrum(Spectrum::Constant(0.9F))};
        BrdfLobeTable table;
        for (const Isa isa : supported_isas())
            expect_close(Shading(isa).reflected(point, photons.photons()), 0.75 * alone, name(isa));
        expect_close(Shading(Isa::plain).reflected(point, photons.photons(), table), 0.75 * alone,
                     "table ");
    }
}

// Where light arrives along the surface the classic lobe has no bound: what is summed is as in evaluate(), to a float's rounding.
TEST(Shading, IsTheLawOf1975WithoutAKernel) {
    const Bsdf bsdf = classic_phong(12);
    Rng rng(51, Stage::test, 0);
    BrdfLobeTable table;
    const PhotonArrays photons = test::random_photons(200, 52);
    for (int place = 0; place < 5; ++place) {
        const ReceiverPoint point = test::random_point(rng, bsdf);
        for (const std::size_t left_out : {std::size_t{17}, WeightedPhotons::none})
            for (const bool weighted : {true, false}) {
                const auto given = photons.photons(weighted, left_out);
                const SpectrumSum truth = oracle(point, photons, weighted, left_out);
                EXPECT_GT(truth[0], 0);
                for (const SpectrumSum& found :
                     {Shading(Isa::plain).reflected(point, given),
                      Shading(Isa::plain).reflected(point, given, table)})
                    for (int c = 0; c < 3; ++c)
                        EXPECT_NEAR(found[c], truth[c], 1e-4 * truth[c]) << place;
            }
    }
}

TEST(Shading, EvaluatesWhatHasNoKernelPhotonByPhoton) {
    // No receiver is glass, but the sum is still what evaluate() says: black.
    const Bsdf glass{Dielectric{}};
    Rng rng(38, Stage::test, 0);
    const ReceiverPoint point = test::random_point(rng, glass);
    const PhotonArrays photons = test::random_photons(20, 39);
    BrdfLobeTable table;
    EXPECT_TRUE((Shading(Isa::plain).reflected(point, photons.photons()) == 0).all());
    EXPECT_TRUE((Shading(Isa::plain).reflected(point, photons.photons(), table) == 0).all());
}

TEST(BrdfLobeTable, WorksEachDirectionOutOnce) {
    const Bsdf bsdf = schlick(0.1F);
    Rng rng(40, Stage::test, 0);
    const ReceiverPoint point = test::random_point(rng, bsdf);
    const PhotonArrays photons = test::random_photons(5'000, 41);
    std::set<int> codes;
    for (std::size_t i = 0; i < photons.size(); ++i)
        codes.insert(photons.direction(i).theta + 256 * photons.direction(i).phi);
    BrdfLobeTable table;
    const Shading shading(Isa::plain);
    const SpectrumSum once = shading.reflected(point, photons.photons(), table);
    EXPECT_EQ(table.lookups(), photons.size());
    EXPECT_EQ(table.fillings(), codes.size());
    EXPECT_TRUE((shading.reflected(point, photons.photons(), table) == once).all());
    EXPECT_EQ(table.lookups(), 2 * photons.size());
    EXPECT_EQ(table.fillings(), codes.size());
}

TEST(BrdfLobeTable, ForgetsWhenThePointOrTheViewChanges) {
    const Bsdf sharp = schlick(0.1F), broad = schlick(0.2F), flat = lambert();
    Rng rng(42, Stage::test, 0);
    const PhotonArrays photons = test::random_photons(100, 43);
    BrdfLobeTable table;
    const Shading shading(Isa::plain);
    ReceiverPoint point = test::random_point(rng, sharp);
    const auto expect_right = [&](const std::string& what) {
        expect_close(shading.reflected(point, photons.photons(), table),
                     oracle(point, photons, false, WeightedPhotons::none), what);
    };
    expect_right("first ");
    point.wo = (point.wo + 0.1F * point.shading_normal).normalized();
    expect_right("view ");
    point.bsdf = &broad;
    expect_right("alpha ");
    point.bsdf = &flat;
    expect_right("model ");
    point = test::random_point(rng, flat);
    expect_right("normal ");
}

}  // namespace
}  // namespace caustics::photonmap
