#include "core/light_path/even_paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/math/lattice.h"
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

/// Counts particles that pass a square of 5 cm on a plane halfway, where every place of the lamp sends some.
double passing(const AimedEmission& emission, const EvenPaths& even, std::uint64_t batch) {
    std::vector<LightPathStart> starts;
    EmissionSamples samples;
    const std::uint64_t first = batch * even.size();
    for (std::uint64_t done = 0; done < even.size(); done += samples.size()) {
        const ConsecutivePaths paths{
            5, static_cast<std::uint32_t>(Stage::test), first + done,
            std::min<std::uint64_t>(even.size() - done, EmissionSamples::most)};
        even.draw(paths, first, emission.kernels(), samples);
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
    std::printf("mean %g var %g\n", mean, variance);
}

}  // namespace
}  // namespace caustics
