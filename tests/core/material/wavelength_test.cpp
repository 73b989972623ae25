#include "core/material/wavelength.h"

#include <gtest/gtest.h>

namespace caustics {
namespace {

// Over equal steps, far finer than the density changes.
template <class Value>
SpectrumSum integral(const Value& value) {
    constexpr int steps = 35'000;
    constexpr double width = (longest_wavelength - shortest_wavelength) / steps;
    SpectrumSum sum = SpectrumSum::Zero();
    for (int i = 0; i < steps; ++i) {
        const double nm = shortest_wavelength + width * (i + 0.5);
        sum += value(nm) * width;
    }
    return sum;
}

TEST(Wavelength, DensitiesOfTheChannelsHaveTheIntegralOne) {
    const SpectrumSum sum = integral([](double nm) { return channel_density(nm); });
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], 1, 1e-6);
    EXPECT_TRUE((channel_density(379) == 0).all());
    EXPECT_TRUE((channel_density(731) == 0).all());
    for (double nm = 380; nm <= 730; nm += 0.5) EXPECT_GE(channel_density(nm).minCoeff(), 0) << nm;
}

// Where the fit of Wyman et al. has the eye's channels: red, green and blue light.
TEST(Wavelength, ColoursAreThoseOfTheRainbow) {
    EXPECT_GT(channel_density(630)[0], 10 * channel_density(630)[1]);
    EXPECT_GT(channel_density(535)[1], 10 * channel_density(535)[0]);
    EXPECT_GT(channel_density(450)[2], 10 * channel_density(450)[1]);
    EXPECT_GT(channel_density(410)[0], 0);  // violet
}

TEST(Wavelength, SamplesStayWhiteAndCarryEqualPower) {
    constexpr int count = 100'000;
    SpectrumSum mean = SpectrumSum::Zero();
    SpectrumSum first_moment = SpectrumSum::Zero();
    for (int i = 0; i < count; ++i) {
        const SampledWavelength sample = sample_wavelength((i + 0.5) / count);
        ASSERT_GE(sample.nm, 380);
        ASSERT_LE(sample.nm, 730);
        ASSERT_GE(sample.weight.minCoeff(), 0);
        ASSERT_NEAR(static_cast<double>(sample.weight.sum()), 3, 1e-5);
        mean += sample.weight.cast<double>() / count;
        first_moment +=
            sample.weight.cast<double>() * static_cast<double>(sample.nm) / double{count};
    }
    const SpectrumSum exact =
        integral([](double nm) -> SpectrumSum { return channel_density(nm) * nm; });
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(mean[c], 1, 1e-5);
        EXPECT_NEAR(first_moment[c], exact[c], 1e-2) << "nm";
    }
    EXPECT_LT(sample_wavelength(0).nm, 381);
    EXPECT_GT(sample_wavelength(1 - 0x1p-32).nm, 729);
}

TEST(Wavelength, BinsAreOfEqualPowerAndAddUpToWhite) {
    for (const int count : {1, 2, 16, 257}) {
        SpectrumSum sum = SpectrumSum::Zero();
        float before = 380;
        for (const WavelengthBin& bin : wavelength_bins(count)) {
            EXPECT_GT(bin.nm, before);
            before = bin.nm;
            EXPECT_GE(bin.weight.minCoeff(), 0);
            EXPECT_NEAR(static_cast<double>(bin.weight.mean()) * count, 1, 1e-4);
            sum += bin.weight.cast<double>();
        }
        EXPECT_LT(before, 730);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], 1, 1e-5) << count;
    }
}

}  // namespace
}  // namespace caustics
