#include "tests/support/picture_agreement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/math/rng.h"
#include "core/math/vec.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

constexpr int width = 48;
constexpr int height = 36;

double truth(std::size_t pixel) { return 1 + 0.5 * std::sin(static_cast<double>(pixel)); }

// An unbiased picture of the truth: 4 % of normal noise a pixel, 0.1 % in the mean.
Film noisy(std::uint64_t seed) {
    Film film(width, height);
    Rng rng(seed, Stage::test, 0);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        Spectrum value, error;
        for (int c = 0; c < 3; ++c) {
            const double r = std::sqrt(-2 * std::log(1 - static_cast<double>(rng.next())));
            const double normal = r * std::cos(2 * pi_d * static_cast<double>(rng.next()));
            value[c] = static_cast<float>(truth(i) * (1 + 0.04 * normal));
            error[c] = static_cast<float>(0.04 * truth(i));
        }
        film.set_rgb("caustic", i, value);
        film.set_rgb("stderr", i, error);
    }
    return film;
}

Film exact(double factor = 1) {
    Film film(width, height);
    for (std::size_t i = 0; i < film.pixel_count(); ++i)
        film.set_rgb("caustic", i, Spectrum::Constant(static_cast<float>(factor * truth(i))));
    return film;
}

std::string complaint(const Film& a, const Film& b) {
    return support::PictureScores(a, b).complaint(0.002);
}

TEST(PictureAgreement, HoldsForPicturesThatDifferByChance) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        EXPECT_EQ(complaint(noisy(2 * seed), noisy(2 * seed + 1)), "") << seed;
        EXPECT_EQ(complaint(noisy(2 * seed), exact()), "") << seed;
    }
}

TEST(PictureAgreement, OnePerCentOfOneChannelIsFound) {
    Film scaled = noisy(2);
    for (float& value : scaled.plane("caustic.B")) value *= 1.01F;
    for (float& value : scaled.plane("stderr.B")) value *= 1.01F;
    const std::string found = complaint(noisy(1), scaled);
    EXPECT_EQ(found.find("B: ratio of the means 0.9"), 0U) << found;
    EXPECT_NE(complaint(noisy(1), exact(1.01)), "");
    EXPECT_NE(complaint(noisy(1), exact(0.99)), "");
}

TEST(PictureAgreement, OnePixelIsFound) {
    Film spot = noisy(2);
    spot.plane("caustic.G")[1234] += 0.5F;
    EXPECT_NE(complaint(noisy(1), spot).find("at pixel 1234"), std::string::npos);
}

TEST(PictureAgreement, StandardErrorsThatAreTooLargeOrTooSmallAreFound) {
    for (const float factor : {0.8F, 1.25F}) {
        Film wrong = noisy(1);
        for (const char* channel : {"stderr.R", "stderr.G", "stderr.B"})
            for (float& value : wrong.plane(channel)) value *= factor;
        EXPECT_NE(complaint(wrong, exact()).find("mean z^2"), std::string::npos) << factor;
    }
}

TEST(PictureAgreement, NothingIsAgreedOnWithoutPixelsOrWithNaN) {
    Film unreached = noisy(1);
    for (float& value : unreached.plane("unreached.Y")) value = 1;
    EXPECT_NE(complaint(unreached, exact()), "");
    EXPECT_NE(complaint(Film(exact(0)), exact(0)), "");
    Film broken = noisy(1);
    broken.plane("caustic.R")[7] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(complaint(broken, exact()), "");
    EXPECT_NE(complaint(exact(1), exact(1.0001)), "") << "pixels without errors are equal or not";
}

TEST(PictureAgreement, FailuresLeaveTheirPictures) {
    const support::TemporaryFolder folder;
    const Film first = noisy(1);
    EXPECT_EQ(support::disagreement(first, noisy(2), 0.002, folder / "none"), "");
    EXPECT_FALSE(std::filesystem::exists(folder / "none"));
    const std::string told = support::disagreement(first, exact(1.01), 0.002, folder / "failed");
    EXPECT_NE(told.find((folder / "failed").string()), std::string::npos) << told;
    EXPECT_EQ(read_exr(folder / "failed" / "first.exr").find("caustic.G")->at(99),
              first.find("caustic.G")->at(99));
    EXPECT_TRUE(std::filesystem::exists(folder / "failed" / "second.exr"));
    EXPECT_TRUE(std::filesystem::exists(folder / "failed" / "z.png"));
    const Film z = read_exr(folder / "failed" / "z.exr");
    const double expected = static_cast<double>(first.rgb("caustic", 99)[1]) - 1.01 * truth(99);
    EXPECT_NEAR(static_cast<double>(z.rgb("", 99)[1]), expected / (0.04 * truth(99)), 1e-3);
}

}  // namespace
}  // namespace caustics
