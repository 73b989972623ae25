#include "photonmap/gather/direction_histogram.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/photonmap/shading_sets.h"

namespace caustics::photonmap {
namespace {

using test::PhotonArrays;

const Vec3 leaning = Vec3(0.3F, -0.2F, 0.9F).normalized();
constexpr int side = 240;  // five to each of the 48 cells

/// Calls take(sample) for a lattice of samples.
template <typename Take>
void for_each_sample(const DirectionHistogram& histogram, const Take& take) {
    for (int i = 0; i < side * side; ++i)
        take(histogram.sample((i % side + 0.5) / side, (i / side + 0.5) / side));
}

/// The mean over samples of weight times f: the integral of f times cosine / pi, whatever the histogram holds.
template <typename Function>
double weighed_mean(const DirectionHistogram& histogram, const Function& f) {
    double sum = 0;
    for_each_sample(histogram, [&](const DirectionHistogram::Sample& sample) {
        sum += static_cast<double>(sample.weight) * static_cast<double>(f(sample.direction));
    });
    return sum / (side * side);
}

PhotonArrays photons_from(const std::vector<Vec3>& directions) {
    PhotonArrays photons(directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i)
        photons.set(i, encode_rgbe(Spectrum::Ones()), encode_direction(directions[i]));
    return photons;
}

// The cosine's own integrals: of 1, of the cosine, 2/3, and of its square, 1/2. Twenty
// middles along the radius are good to 1e-3.
TEST(DirectionHistogram, WithoutPhotonsIsTheCosine) {
    const DirectionHistogram histogram(leaning, {});
    for_each_sample(histogram, [](const DirectionHistogram::Sample& sample) {
        EXPECT_NEAR(sample.weight, 1, 1e-5F);
        EXPECT_NEAR(sample.direction.norm(), 1, 1e-6F);
        EXPECT_GE(sample.direction.dot(leaning), -1e-6F);
    });
    const auto cosine = [](const Vec3& wi) { return wi.dot(leaning); };
    EXPECT_NEAR(weighed_mean(histogram, cosine), 2.0 / 3, 1e-3);
    EXPECT_NEAR(weighed_mean(histogram, [&](const Vec3& wi) { return cosine(wi) * cosine(wi); }),
                0.5, 1e-3);
}

// Half of the samples go where the light comes from, and weigh the less: means stay.
TEST(DirectionHistogram, GoesWhereThePhotonsComeFromAndKeepsTheMean) {
    const Vec3 from = Frame(leaning).to_world(Vec3(0.5F, 0.3F, 0.81F)).normalized();
    const DirectionHistogram histogram(leaning, photons_from({from, from}).photons().photons);
    double near = 0;
    for_each_sample(histogram, [&](const DirectionHistogram::Sample& sample) {
        near += sample.weight < 0.5F ? 1 : 0;
        // Its cell has half of all and its own part of the rest; another one half of its part.
        EXPECT_NEAR(sample.weight, sample.weight < 0.5F ? 1 / (0.5F * 48 + 0.5F) : 2, 1e-4F);
        if (sample.weight < 0.5F) {
            EXPECT_GT(sample.direction.dot(from), 0.8F);
        }
    });
    EXPECT_NEAR(near / (side * side), 0.5 + 0.5 / 48, 1.0 / side);
    EXPECT_NEAR(weighed_mean(histogram, [](const Vec3&) { return 1; }), 1, 0.02);
    EXPECT_NEAR(weighed_mean(histogram, [](const Vec3& wi) { return wi.dot(leaning); }), 2.0 / 3,
                0.02);
}

// What comes from below the normal, as under a leaning one, sends nothing there and is no part of all.
TEST(DirectionHistogram, LeavesOutWhatComesFromBelow) {
    const Vec3 from = Frame(leaning).to_world(Vec3(-0.6F, 0.2F, 0.77F)).normalized();
    const PhotonArrays above = photons_from({from});
    const PhotonArrays both = photons_from({-leaning, from, (-leaning + 0.2F * from).normalized()});
    const DirectionHistogram one(leaning, above.photons().photons);
    const DirectionHistogram other(leaning, both.photons().photons);
    for (int i = 0; i < 100; ++i) {
        const auto a = one.sample((i + 0.5) / 100, 0.3), b = other.sample((i + 0.5) / 100, 0.3);
        EXPECT_EQ(a.direction, b.direction) << i;
        EXPECT_EQ(a.weight, b.weight) << i;
    }
    const DirectionHistogram below(leaning, photons_from({-leaning}).photons().photons);
    EXPECT_NEAR(below.sample(0.2, 0.7).weight, 1, 1e-5F) << "as without photons";
}

}  // namespace
}  // namespace caustics::photonmap
