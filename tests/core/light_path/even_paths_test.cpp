#include "core/light_path/even_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/support/build_scene.h"

namespace caustics {
namespace {

/// A square lamp of half a metre's half side, two metres above a ball of glass.
Scene ball_under_a_lamp() {
    SceneDesc desc;
    desc.shapes = {support::sphere("ball", {0, 0, 0}, 0.3, support::glass(1.5F)),
                   support::horizontal("lamp", 2, 0.5, false, support::diffuse(0))};
    desc.shapes[1].radiance = Spectrum(1, 1, 1);
    return Scene(std::move(desc));
}

Scene ball_under_a_point() {
    SceneDesc desc;
    desc.shapes = {support::sphere("ball", {0, 0, 0}, 0.3, support::glass(1.5F))};
    desc.lights = {support::point_light({0, 0, 2}, 1)};
    return Scene(std::move(desc));
}

ConsecutivePaths paths_from(std::uint64_t first, std::size_t count) {
    return {5, static_cast<std::uint32_t>(Stage::test), first, count};
}

/// Counts the particles through a square of 5 cm on the plane z = 1, which light of every point of the lamp crosses.
double passing(const AimedEmission& emission, const EvenPaths& even, std::uint64_t batch) {
    std::vector<LightPathStart> starts;
    EmissionSamples samples;
    const std::uint64_t first = batch * even.size();
    for (std::uint64_t done = 0; done < even.size(); done += samples.size()) {
        const auto count = std::min<std::uint64_t>(even.size() - done, EmissionSamples::most);
        even.draw(paths_from(first + done, count), first, emission.kernels(), samples);
        emission.emit(samples, starts);
    }
    double count = 0;
    for (const LightPathStart& start : starts) {
        const Ray& ray = start.particle.ray;
        const Vec3 at = ray.origin + (1 - ray.origin.z()) / ray.direction.z() * ray.direction;
        if (std::abs(at.x() - 0.1F) < 0.025F && std::abs(at.y()) < 0.025F) ++count;
    }
    return count;
}

TEST(EvenPaths, OfALampAreEvenerThanChanceOnAPlaneBetween) {
    const Scene scene = ball_under_a_lamp();
    const AimedEmission emission(scene);
    const EvenPaths even = EvenPaths::at_most(emission, 100'000);
    EXPECT_EQ(even.size(), 100'000U);
    constexpr int batches = 24;
    double sum = 0, squares = 0;
    for (std::uint64_t batch = 0; batch < batches; ++batch) {
        const double count = passing(emission, even, batch);
        sum += count;
        squares += count * count;
    }
    const double mean = sum / batches;
    const double variance = (squares - batches * mean * mean) / (batches - 1);
    EXPECT_GT(mean, 100);
    // Random particles have a variance of the mean. Thinning by the cosine leaves some of it.
    EXPECT_LT(variance, 0.4 * mean);
}

// Every number of a path is in each of ten equal parts as often, whatever numbers the other paths have.
TEST(EvenPaths, OfALampHaveEightEvenNumbers) {
    const Scene scene = ball_under_a_lamp();
    const AimedEmission emission(scene);
    constexpr std::uint64_t size = 2000;
    const EvenPaths even = EvenPaths::at_least(emission, size);
    std::array<std::array<int, 10>, 8> found = {};
    EmissionSamples samples;
    for (std::uint64_t first = 0; first < size; first += 250) {
        even.draw(paths_from(size + first, 250), size, emission.kernels(), samples);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            Rng rng = samples.rng(i, 0);
            for (std::size_t k = 0; k < 8; ++k)
                ++found[k][static_cast<std::size_t>(10 * rng.next_fine())];
        }
    }
    for (const auto& parts : found)
        for (const int count : parts) EXPECT_NEAR(count, size / 10, 8);
}

// A path has the same numbers wherever a run of paths begins, and others in another batch.
TEST(EvenPaths, OfALampDependOnTheirBatchAlone) {
    const Scene scene = ball_under_a_lamp();
    const AimedEmission emission(scene);
    const EvenPaths even = EvenPaths::at_most(emission, 100);
    EmissionSamples all, some, later;
    even.draw(paths_from(100, 100), 100, emission.kernels(), all);
    even.draw(paths_from(137, 20), 100, emission.kernels(), some);
    even.draw(paths_from(200, 100), 200, emission.kernels(), later);
    for (std::size_t i = 0; i < some.size(); ++i) {
        Rng one = all.rng(37 + i), other = some.rng(i), third = later.rng(37 + i);
        EXPECT_EQ(all.x()[37 + i], some.x()[i]);
        EXPECT_EQ(all.y()[37 + i], some.y()[i]);
        EXPECT_NE(all.x()[37 + i], later.x()[37 + i]);
        bool is_third = true;
        for (int k = 0; k < 20; ++k) {
            const std::uint32_t word = one.next_word();
            EXPECT_EQ(word, other.next_word());
            is_third = is_third && word == third.next_word();
        }
        EXPECT_FALSE(is_third);
    }
}

TEST(EvenPaths, OfAPointAreInStrata) {
    const Scene scene = ball_under_a_point();
    const AimedEmission emission(scene);
    const EvenPaths even = EvenPaths::at_least(emission, 90);
    const StratifiedSquare square = StratifiedSquare::at_least(90);
    ASSERT_EQ(even.size(), square.size());
    EmissionSamples samples, placed;
    even.draw(paths_from(7, 50), 7, emission.kernels(), samples);
    placed.draw(paths_from(7, 50), emission.kernels());
    square.place(0, placed.x(), placed.y());
    EXPECT_TRUE(std::ranges::equal(samples.x(), placed.x()));
    EXPECT_TRUE(std::ranges::equal(samples.y(), placed.y()));
}

}  // namespace
}  // namespace caustics
