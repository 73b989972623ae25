#include "photonmap/photons/rgbe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/math/rng.h"

namespace caustics::photonmap {
namespace {

TEST(Rgbe, ErrsByAtMostA255thOfTheLargestChannelOverAllScales) {
    Rng rng(1, Stage::test, 0);
    for (int exponent = -120; exponent <= 120; exponent += 3) {
        for (int i = 0; i < 200; ++i) {
            const float r = rng.next(), g = rng.next(), b = rng.next();
            const Spectrum value = Spectrum(r, g, b) * std::ldexp(1.0F, exponent);
            const Spectrum error = (decode_rgbe(encode_rgbe(value)) - value).abs();
            EXPECT_LE(error.maxCoeff(), value.maxCoeff() / 255) << value.transpose();
        }
    }
}

TEST(Rgbe, RoundsInsteadOfTruncating) {
    double mean = 0;
    constexpr int steps = 10'000;
    for (int i = 0; i < steps; ++i) {
        const float value = 0.5F + 0.5F * (static_cast<float>(i) + 0.5F) / steps;
        mean += static_cast<double>(decode_rgbe(encode_rgbe(Spectrum::Constant(value)))[0] - value);
    }
    EXPECT_LT(std::abs(mean / steps), 1e-5);
}

TEST(Rgbe, KeepsZeroExactlyZero) {
    EXPECT_EQ(encode_rgbe(black()), Rgbe{});
    EXPECT_TRUE(is_black(decode_rgbe(Rgbe{})));
    const Spectrum green = decode_rgbe(encode_rgbe({0, 0.7F, 0}));
    EXPECT_EQ(green[0], 0);
    EXPECT_EQ(green[2], 0);
    EXPECT_GT(green[1], 0);
}

TEST(Rgbe, KeepsItsOwnValuesAndReads255AsTheFinest) {
    const Spectrum value(255.0F / 256, 3.0F / 256, 0.5F);
    EXPECT_TRUE((decode_rgbe(encode_rgbe(value)) == value).all());
}

TEST(Rgbe, CarriesIntoTheNextExponentWhenRoundingUp) {
    const Spectrum value = Spectrum::Constant(255.75F / 256);
    EXPECT_EQ(encode_rgbe(value).mantissa[0], 128);
    EXPECT_TRUE((decode_rgbe(encode_rgbe(value)) == Spectrum::Ones()).all());
}

TEST(Rgbe, RoundedAtRandomKeepsTheMeanOfEveryChannel) {
    constexpr int draws = 200'000;
    for (const Spectrum& value :
         {Spectrum(1, 0.0025F, 0.00012F), Spectrum(0.6021F, 0.1234F, 0.6F),
          Spectrum(3e-7F, 255.49F / 256, 255.01F / 256), Spectrum(1e-30F, 2e-33F, 0)}) {
        Rng rng(5, Stage::test, 0);
        SpectrumSum sum = SpectrumSum::Zero(), squares = SpectrumSum::Zero();
        for (int i = 0; i < draws; ++i) {
            const double a = rng.next_fine(), b = rng.next_fine(), c = rng.next_fine();
            const SpectrumSum got = decode_rgbe(encode_rgbe(value, {a, b, c})).cast<double>();
            sum += got;
            squares += got.square();
        }
        const SpectrumSum mean = sum / draws, truth = value.cast<double>();
        const SpectrumSum error = ((squares / draws - mean.square()).max(0) / draws).sqrt();
        for (int c = 0; c < 3; ++c)
            EXPECT_LE(std::abs(mean[c] - truth[c]), 4 * error[c] + 2e-6 * truth[c])
                << value.transpose() << ", channel " << c;
    }
}

TEST(Rgbe, WholeMantissasNeedNoChance) {
    const float typical = 255.0F / 256;
    const float above = std::nextafter(std::nextafter(typical, 1.0F), 1.0F);
    for (const float value : {typical, std::nextafter(typical, 0.0F), above, 3.0F / 256, 64.0F})
        for (const double chance : {0.0, 0.5, 1 - 0x1p-32})
            EXPECT_EQ(encode_rgbe(Spectrum(value, 0, value), {chance, chance, chance}),
                      encode_rgbe(Spectrum(value, 0, value)));
}

TEST(Rgbe, LosesWhatIsBelowItsRangeAndRefusesTheRest) {
    EXPECT_EQ(encode_rgbe(Spectrum::Constant(1e-40F)), Rgbe{});
    EXPECT_THROW(encode_rgbe(Spectrum::Constant(2e38F)), std::range_error);
    EXPECT_THROW(encode_rgbe({1, -1, 1}), std::range_error);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(encode_rgbe({1, nan, 1}), std::range_error);
    EXPECT_THROW(encode_rgbe({1, std::numeric_limits<float>::infinity(), 1}), std::range_error);
}

// Up to 255 of 256 parts of 2^126; what rounds to more has no exponent.
TEST(Rgbe, EndsWhereTheLargestMantissaOfTheLargestExponentDoes) {
    const Spectrum largest = Spectrum::Constant(255.0F / 256 * 0x1p126F);
    EXPECT_EQ(encode_rgbe(largest).exponent, 254);
    EXPECT_TRUE((decode_rgbe(encode_rgbe(largest)) == largest).all());
    EXPECT_EQ(encode_rgbe(largest), encode_rgbe(largest, {0.5, 0.5, 0.5}));
    const Spectrum beyond = Spectrum::Constant(std::nextafter(0x1p126F, 0.0F));
    EXPECT_THROW(encode_rgbe(beyond), std::range_error);
    EXPECT_THROW(encode_rgbe(beyond, {0.5, 0.5, 0.5}), std::range_error);
}

}  // namespace
}  // namespace caustics::photonmap
