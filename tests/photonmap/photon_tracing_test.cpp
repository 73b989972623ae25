#include "photonmap/photons/photon_tracing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/math/rng.h"
#include "photonmap/photons/photon_yield.h"
#include "tests/support/statistics.h"

namespace caustics::photonmap {
namespace {

/// What path number `path` deposits, if it does.
using OnePath = std::function<std::optional<Deposit>(std::uint64_t path)>;

/// Paths of one photon at most, given one by one; all are aimed, the others miss.
class GivenPaths final : public PathTracer {
public:
    explicit GivenPaths(OnePath one) : one_(std::move(one)) {}
    void trace(std::uint64_t first, std::uint64_t last, PhotonChunk& chunk) const override {
        for (std::uint64_t path = first; path < last; ++path) {
            const std::optional<Deposit> deposit = one_(path);
            ++chunk.counts.emitted;
            ++chunk.counts.aimed;
            ++(deposit ? chunk.counts.stored : chunk.counts.missed);
            if (deposit) chunk.add(path, *deposit);
        }
    }

private:
    OnePath one_;
};

/// Paths that store with probability `rate`, white and 1 W.
OnePath synthetic_paths(float rate, std::uint64_t seed = 1) {
    return [rate, seed](std::uint64_t path) -> std::optional<Deposit> {
        Rng rng(seed, Stage::test, path);
        if (rng.next() >= rate) return {};
        Deposit deposit;
        const float x = rng.next(), y = rng.next();
        deposit.position = {x, y, 0};
        deposit.wi = deposit.geometric_normal = deposit.shading_normal = Vec3::UnitZ();
        deposit.uv = Vec2::Zero();
        deposit.flux = Spectrum::Ones();
        return deposit;
    };
}

TracedPhotons trace(const OnePath& paths, PhotonTarget target, const RunOptions& options,
                    const Spectrum& flux = Spectrum::Ones()) {
    target.capacity = std::max(target.stored, target.emitted);
    return trace_photons(GivenPaths(paths), flux, target, options);
}

TracedPhotons trace(const OnePath& paths, const PhotonTarget& target, int threads = 1) {
    RunOptions options;
    options.threads = threads;
    return trace(paths, target, options);
}

TEST(PhotonTracing, StoresExactlyAsManyAsAsked) {
    for (const float rate : {1.0F, 0.5F, 0.01F}) {
        for (const std::uint64_t stored : {1U, 2U, 63U, 64U, 65U, 5'000U}) {
            const TracedPhotons traced = trace(synthetic_paths(rate), {.stored = stored}, 2);
            EXPECT_EQ(traced.store.size(), stored);
            EXPECT_EQ(traced.counts.stored, stored);
            EXPECT_EQ(traced.counts.emitted, traced.counts.stored + traced.counts.missed);
            EXPECT_EQ(traced.counts.aimed, traced.counts.emitted);
            EXPECT_TRUE(rate < 1 || traced.counts.emitted == stored);
        }
    }
}

TEST(PhotonTracing, CountsThePathsBeforeTheNextPhoton) {
    const OnePath paths = synthetic_paths(0.3F);
    const TracedPhotons traced = trace(paths, {.stored = 100});
    std::uint64_t successes = 0;
    std::uint64_t path = 0;
    for (;; ++path)
        if (paths(path) && ++successes == 101) break;
    EXPECT_EQ(traced.counts.emitted, path);
}

TEST(PhotonTracing, EmitsExactlyAsManyAsAsked) {
    for (const std::uint64_t emitted : {1U, 64U, 1'000U, 100'003U}) {
        const TracedPhotons traced = trace(synthetic_paths(0.25F), {.emitted = emitted}, 2);
        EXPECT_EQ(traced.counts.emitted, emitted);
        EXPECT_EQ(traced.counts.stored, traced.store.size());
        EXPECT_EQ(traced.counts.stored + traced.counts.missed, emitted);
    }
}

TEST(PhotonTracing, GivesTheSamePhotonsForAnyNumberOfThreads) {
    for (const PhotonTarget& target :
         {PhotonTarget{.stored = 30'000}, PhotonTarget{.emitted = 90'000}}) {
        const TracedPhotons one = trace(synthetic_paths(0.4F), target, 1);
        for (const int threads : {2, 3, 7}) {
            const TracedPhotons more = trace(synthetic_paths(0.4F), target, threads);
            ASSERT_EQ(more.store.size(), one.store.size());
            EXPECT_EQ(more.counts.emitted, one.counts.emitted);
            EXPECT_EQ(std::memcmp(more.store.photons().data(), one.store.photons().data(),
                                  one.store.bytes()),
                      0);
        }
    }
}

TEST(PhotonTracing, StoppingAtACountLeavesTheFluxUnbiased) {
    constexpr float rate = 0.3F;
    constexpr std::uint64_t runs = 4'000;
    for (std::uint64_t stored = 1; stored <= 5; ++stored) {
        double sum = 0, squares = 0;
        for (std::uint64_t run = 0; run < runs; ++run) {
            const TracedPhotons traced =
                trace(synthetic_paths(rate, 1'000 * run + stored), {.stored = stored});
            const double flux = static_cast<double>(traced.store.size()) /
                                static_cast<double>(traced.counts.emitted);
            sum += flux;
            squares += flux * flux;
        }
        const double mean = sum / runs;
        const double error = std::sqrt((squares / runs - mean * mean) / runs);
        EXPECT_NEAR(mean, static_cast<double>(rate), 4 * error) << stored;
        // Dividing by the paths up to the last photon itself would be far off.
        EXPECT_LT(4 * error, 0.1 * static_cast<double>(rate));
    }
}

// Of five photons two are kept: all ten pairs equally often.
TEST(PhotonTracing, DropsEveryPhotonEquallyLikely) {
    std::vector<double> counts(10);
    constexpr int seeds = 20'000;
    for (int seed = 0; seed < seeds; ++seed) {
        TracedPhotons traced{PhotonStore(5), {}, Spectrum::Ones()};
        for (int i = 0; i < 5; ++i) {
            Photon photon{};
            photon.position[0] = static_cast<float>(i);
            traced.store.append(std::span<const Photon>(&photon, 1));
        }
        traced.counts.stored = 5;
        drop_photons(traced, 2, static_cast<std::uint64_t>(seed));
        ASSERT_EQ(traced.store.size(), 2U);
        ASSERT_EQ(traced.counts.stored, 2U);
        ASSERT_EQ(traced.counts.dropped, 3U);
        const auto place = [&](std::size_t i) {
            return static_cast<int>(traced.store.photons()[i].position[0]);
        };
        const int low = std::min(place(0), place(1));
        const int high = std::max(place(0), place(1));
        ASSERT_LT(low, high);
        counts[static_cast<std::size_t>(high * (high - 1) / 2 + low)] += 1;
    }
    EXPECT_GT(support::chi_square_p_value(counts, std::vector<double>(10, seeds / 10.0)), 1e-3);
}

TEST(PhotonTracing, KeepsFluxOverTwelveOrdersOfMagnitudeAndAnyColour) {
    for (const float watts : {1e-6F, 1.0F, 1e6F}) {
        const Spectrum flux = watts * Spectrum(1, 0.001F, 0);
        const OnePath paths = [&](std::uint64_t path) {
            std::optional<Deposit> deposit = synthetic_paths(1)(path);
            deposit->flux = flux;
            return deposit;
        };
        const TracedPhotons traced = trace(paths, {.stored = 10}, {}, flux);
        const Spectrum kept = decode_rgbe(traced.store.photons().front().energy) * traced.flux_unit;
        EXPECT_NEAR(kept[0] / flux[0], 1, 1e-6);
        EXPECT_NEAR(kept[1] / flux[1], 1, 1e-6);
        EXPECT_EQ(kept[2], 0);
    }
}

// Each number is finite; their sum is beyond the largest float.
TEST(PhotonTracing, KeepsFluxWhoseSumIsNoFloat) {
    const Spectrum flux = Spectrum::Constant(2e38F);
    ASSERT_TRUE(std::isinf(flux.sum()));
    const OnePath paths = [&](std::uint64_t path) {
        std::optional<Deposit> deposit = synthetic_paths(1)(path);
        deposit->flux = flux;
        return deposit;
    };
    const TracedPhotons traced = trace(paths, {.stored = 10}, {}, flux);
    for (const Photon& photon : traced.store.photons())
        EXPECT_LT((decode_rgbe(photon.energy) * (traced.flux_unit / flux) - 1).abs().maxCoeff(),
                  1e-6F);
}

// Without a path there is nothing to divide by, without a photon nothing that was dropped.
TEST(PhotonTracing, TheUnitOfNoPhotonsIsFinite) {
    const Spectrum unit(1, 2, 3);
    for (const std::uint64_t emitted : {std::uint64_t{0}, std::uint64_t{9}}) {
        TracedPhotons none{PhotonStore(0), {}, unit};
        none.counts.emitted = emitted;
        EXPECT_TRUE((none.flux_per_energy() == unit).all()) << emitted;
    }
    const TracedPhotons some{PhotonStore(0), {.emitted = 10, .stored = 1, .dropped = 3}, unit};
    EXPECT_LT((some.flux_per_energy() / unit - 0.4F).abs().maxCoeff(), 1e-6F);
}

std::string refusal_of_yield(const OnePath& paths, std::uint64_t wanted) {
    try {
        require_yield(GivenPaths(paths), {.count = wanted,
                                          .path_flux = Spectrum::Ones(),
                                          .method = "photonmap",
                                          .otherwise = "give `emitted`",
                                          .when_hardly_any = "give `emitted`"});
    } catch (const UnsupportedScene& error) {
        return error.what();
    }
    return "";
}

TEST(PhotonYield, IsRefusedByTheRateOfHits) {
    EXPECT_EQ(refusal_of_yield(synthetic_paths(0.5F), 1'000'000'000), "");
    EXPECT_EQ(refusal_of_yield(synthetic_paths(0.001F), 1'000'000), "") << "one in a thousand";
    EXPECT_EQ(refusal_of_yield(synthetic_paths(0.0001F), 1'000), "") << "ten million paths";
    const std::string few = refusal_of_yield(synthetic_paths(0.0001F), 1'000'000);
    EXPECT_NE(few.find("of 1000000 photons, which would take some 9e+09 light paths"),
              std::string::npos)
        << few;
    EXPECT_NE(few.find("met no caster first"), std::string::npos) << few;
    EXPECT_NE(few.find("(give `emitted`)"), std::string::npos) << few;
    EXPECT_NE(refusal_of_yield(synthetic_paths(0.000001F), 1), "") << "the rate is not known";
    const std::string none = refusal_of_yield(synthetic_paths(0), 1);
    EXPECT_NE(none.find("no photon can be stored: no light path met a caster"), std::string::npos)
        << none;
}

TEST(PhotonYield, TakesBoundedWork) {
    const auto followed = [](float rate) {
        std::uint64_t count = 0;
        const OnePath paths = synthetic_paths(rate);
        refusal_of_yield(
            [&](std::uint64_t path) {
                ++count;
                return paths(path);
            },
            1'000'000'000);
        return count;
    };
    EXPECT_EQ(followed(0), 2'000'000U);
    EXPECT_EQ(followed(0.000001F), 2'000'000U);
    EXPECT_LE(followed(0.01F), 100'000U);
    EXPECT_EQ(followed(1), 4096U);
}

TEST(PhotonTracing, NamesThePathOfAPhotonThatIsNotFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (int broken = 0; broken < 4; ++broken) {
        const OnePath paths = [&](std::uint64_t path) {
            std::optional<Deposit> deposit = synthetic_paths(1)(path);
            if (path == 77 && broken == 0) deposit->position.y() = nan;
            if (path == 77 && broken == 1) deposit->flux[2] = nan;
            if (path == 77 && broken == 2) deposit->flux[0] = -1;
            if (path == 77 && broken == 3) deposit->wi.z() = nan;
            return deposit;
        };
        try {
            trace(paths, {.emitted = 1'000}, 2);
            FAIL() << "expected an error";
        } catch (const std::runtime_error& e) {
            EXPECT_NE(std::string(e.what()).find("path 77"), std::string::npos) << e.what();
        }
    }
}

TEST(PhotonTracing, ReportsGrowingProgressAndCanBeInterrupted) {
    RunOptions options;
    std::vector<double> shares;
    options.progress = [&](double share) { shares.push_back(share); };
    trace(synthetic_paths(0.5F), {.stored = 20'000}, options);
    EXPECT_TRUE(std::ranges::is_sorted(shares));
    EXPECT_GT(shares.size(), 2U);
    EXPECT_EQ(shares.back(), 1);
    options.progress = [](double) { throw Interrupted(); };
    EXPECT_THROW(trace(synthetic_paths(0.5F), {.stored = 20'000}, options), Interrupted);
}

}  // namespace
}  // namespace caustics::photonmap
