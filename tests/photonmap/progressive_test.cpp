#include "photonmap/progressive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "estimate_map.h"
#include "tests/support/statistics.h"

namespace caustics::photonmap {
namespace {

using test::EstimateMap;
using test::floor_point;

TEST(Progressive, SharesFollowTheRecurrenceAndFallAsAPower) {
    EXPECT_EQ(pass_share(0), 1);
    for (const int i : {1, 2, 10}) {
        const double ratio = (i + 2.0 / 3) / (i + 1);
        EXPECT_NEAR(pass_share(i) / pass_share(i - 1), ratio, 1e-15);
    }
    EXPECT_NEAR(pass_share(100'000) / std::pow(1e5, -1.0 / 3), 1 / std::tgamma(5.0 / 3), 1e-5);
}

TEST(Progressive, PassesHaveSeedsOfTheirOwn) {
    EXPECT_EQ(pass_seed(7, 0), 7U);
    std::set<std::uint64_t> seeds;
    for (const std::uint64_t seed : {1ULL, 2ULL, 1ULL << 40U})
        for (int pass = 0; pass < 500; ++pass) seeds.insert(pass_seed(seed, pass));
    EXPECT_EQ(seeds.size(), 1'500U);
}

TEST(Progressive, EveryPassIsUnbiasedInAUniformField) {
    constexpr std::size_t photons = 400'000;
    const EstimateMap map(test::uniform_field(photons, 61));
    const auto fewer = static_cast<float>(std::sqrt(20 / (pi_d * photons)));
    for (const int pass : {1, 5, 50})
        for (const float max_radius : {1.0F, fewer})
            for (const bool adaptive : {false, true}) {
                const RadianceEstimate::Settings settings{.limits = {20, max_radius, adaptive},
                                                          .filter = {FilterKind::cone},
                                                          .adaptive = adaptive,
                                                          .share = pass_share(pass)};
                support::Moments moments;
                for (const Spectrum& value : map.irradiance(settings, test::square_grid(110)))
                    moments.add(static_cast<double>(value[0]) / photons);
                EXPECT_NEAR(moments.mean(), 1, 4 * moments.standard_error()) << pass;
                EXPECT_LT(moments.standard_error(), 0.006);
            }
}

/// What a query at the middle of a disc of light finds, whose density falls as 1 - r^2 from 2 / pi
/// there to nothing at its rim, and which many photons fill.
class FadingDisc {
public:
    static constexpr std::size_t photons = 200;
    static constexpr std::size_t nearest = 60;
    static constexpr double middle = 2 / pi_d;

    /// The nearest photons of a map with that seed.
    GatheredPhotons gather(std::uint64_t seed) {
        Rng rng(seed, Stage::test, 0);
        for (float& u : squared_distance_) u = 1 - std::sqrt(1 - rng.next());
        std::ranges::nth_element(squared_distance_, squared_distance_.begin() + nearest - 1);
        return {.squared_distance = squared_distance_.data(),
                .energy = energy_.data(),
                .direction = direction_.data(),
                .count = nearest,
                .farthest = nearest - 1,
                .full = true};
    }

private:
    static std::uint32_t one() {
        const Rgbe energy = encode_rgbe(Spectrum::Ones());
        return std::bit_cast<std::uint32_t>(energy);
    }
    std::vector<float> squared_distance_ = std::vector<float>(photons);
    std::vector<std::uint32_t> energy_ = std::vector<std::uint32_t>(photons + 8, one());
    std::vector<std::uint16_t> direction_ = std::vector<std::uint16_t>(photons + 8);
};

/// The slope of log y over log x, by least squares.
double rate(const std::vector<double>& x, const std::vector<double>& y) {
    double mean_x = 0, mean_y = 0, product = 0, square = 0;
    const auto n = static_cast<double>(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        mean_x += std::log(x[i]) / n;
        mean_y += std::log(y[i]) / n;
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        product += (std::log(x[i]) - mean_x) * (std::log(y[i]) - mean_y);
        square += std::pow(std::log(x[i]) - mean_x, 2);
    }
    return product / square;
}

TEST(Progressive, ErrorFallsAtThePublishedRate) {
    // Where the light is brightest a disc reads low: both parts of the error, after 16, 32, ...,
    // 256 passes.
    constexpr int runs = 600, most_passes = 256;
    const std::vector<double> counts{16, 32, 64, 128, 256};
    std::vector<support::Moments> means(counts.size());
    std::vector<double> squares(counts.size());
    FadingDisc disc;
    EstimateScratch scratch;
    std::vector<RadianceEstimate> estimates;
    for (int pass = 0; pass < most_passes; ++pass)
        estimates.emplace_back(RadianceEstimate::Settings{.limits = {FadingDisc::nearest, 1},
                                                          .share = pass_share(pass)},
                               widest_isa());
    for (int run = 0; run < runs; ++run) {
        double sum = 0;
        for (int pass = 0; pass < most_passes; ++pass) {
            const auto seed = static_cast<std::uint64_t>(run * most_passes + pass);
            sum += static_cast<double>(estimates[static_cast<std::size_t>(pass)].irradiance(
                       floor_point(Vec3::Zero()), disc.gather(seed), scratch)[0]) /
                   (FadingDisc::photons * FadingDisc::middle);
            for (std::size_t i = 0; i < counts.size(); ++i)
                if (counts[i] == pass + 1) {
                    means[i].add(sum / (pass + 1));
                    squares[i] += std::pow(sum / (pass + 1) - 1, 2) / runs;
                }
        }
    }
    std::vector<double> biases, variances;
    for (const support::Moments& mean : means) {
        biases.push_back(1 - mean.mean());
        variances.push_back(std::pow(mean.deviation(), 2));
        // Neither part is small.
        EXPECT_GT(std::pow(biases.back(), 2), 0.3 * variances.back());
        EXPECT_GT(variances.back(), 0.3 * std::pow(biases.back(), 2));
    }
    EXPECT_NEAR(rate(counts, squares), -2.0 / 3, 0.1);
    EXPECT_NEAR(rate(counts, variances), -2.0 / 3, 0.1);
    EXPECT_NEAR(rate(counts, biases), -1.0 / 3, 0.1);
}

}  // namespace
}  // namespace caustics::photonmap
