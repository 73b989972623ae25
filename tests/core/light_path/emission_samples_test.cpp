#include "core/light_path/emission_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/light_path/aimed_emission.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

constexpr std::uint64_t far = (std::uint64_t{1} << 32U) - 100;  // where a path's number gets longer

EmissionSamples draw(std::uint64_t first, std::size_t count, Isa isa) {
    EmissionSamples samples;
    samples.draw({7, static_cast<std::uint32_t>(Stage::test), first, count}, emission_kernels(isa));
    return samples;
}

TEST(EmissionSamples, AreTheBeginningsOfThePathsStreams) {
    for (const Isa isa : supported_isas())
        for (const std::size_t count : {std::size_t{1}, std::size_t{19}, EmissionSamples::most}) {
            const EmissionSamples samples = draw(far, count, isa);
            for (std::size_t i = 0; i < count; ++i) {
                Rng expected(7, Stage::test, far + i);
                EXPECT_EQ(samples.path(i), far + i);
                EXPECT_EQ(samples.x()[i], expected.next_fine()) << name(isa) << " " << i;
                EXPECT_EQ(samples.y()[i], expected.next_fine()) << name(isa) << " " << i;
                Rng rest = samples.rng(i);
                for (int word = 2; word < 9; ++word)
                    EXPECT_EQ(rest.next_word(), expected.next_word()) << name(isa) << " " << i;
            }
        }
}

// Lights of every kind round casters that hide each other.
SceneDesc lights_of_every_kind() {
    SceneDesc desc;
    desc.shapes = {support::sphere("ball", {0, 0, 0}, 0.5, support::glass(1.5F)),
                   support::sphere("near", {0.4, 0, 0.3}, 0.4, support::glass(1.3F)),
                   support::horizontal("mirror", -1, 0.7, true, support::mirror()),
                   support::horizontal("lamp", 2, 0.5, false, support::diffuse(0)),
                   support::sphere("bulb", {2, 1, 1}, 0.1, support::diffuse(0))};
    desc.shapes[3].radiance = Spectrum(3, 2, 1);
    desc.shapes[4].radiance = Spectrum(20, 30, 40);
    desc.lights = {support::point_light({1, 2, 3}, 2), support::point_light({0, 0, 0}, 1)};
    desc.lights.emplace_back(support::directional_light({0, 0.6, -0.8}, 1));
    return desc;
}

// To the bit, whichever registers: the same particles as of one path at a time.
TEST(EmissionSamples, MakeTheParticlesOfSinglePaths) {
    const Scene scene(lights_of_every_kind());
    const AimedEmission single(scene);
    for (const Isa isa : supported_isas()) {
        const AimedEmission emission(scene, isa);
        std::vector<LightPathStart> starts;
        const std::uint64_t end = far + 20 * EmissionSamples::most + 5;
        for (std::uint64_t first = far; first < end; first += EmissionSamples::most)
            emission.emit(draw(first, std::min(end - first, EmissionSamples::most), isa), starts);
        auto start = starts.begin();
        for (std::uint64_t path = far; path < end; ++path) {
            Rng rng(7, Stage::test, path);
            const auto expected = single.emit(rng);
            if (!expected) continue;  // thinned out
            ASSERT_TRUE(start != starts.end());
            ASSERT_EQ(start->path, path) << name(isa);
            EXPECT_EQ(start->particle.ray.origin, expected->ray.origin) << name(isa);
            EXPECT_EQ(start->particle.ray.direction, expected->ray.direction) << name(isa);
            EXPECT_TRUE((start->particle.flux == expected->flux).all()) << name(isa);
            EXPECT_EQ(start->rng.next_word(), rng.next_word()) << name(isa);
            ++start;
        }
        EXPECT_TRUE(start == starts.end());
        EXPECT_LT(starts.size(), end - far);
        EXPECT_GT(starts.size(), 2'000U);
    }
}

// All directions, from the rim of the square: its far side rounds to 1 in float.
TEST(EmissionSamples, AreAimedInUnitDirectionsFromTheRimToo) {
    constexpr std::size_t count = 1 << 18;
    const EmissionCone whole{2, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::vector<std::uint32_t> cone(count, 0);
    std::vector<double> end(count), along(count);
    std::vector<float> disc_x(count), disc_y(count), x(count), y(count), z(count);
    for (std::size_t i = 0; i < count; ++i) {
        end[i] = i % 2 == 0 ? 0 : 1 - 0x1p-32;
        along[i] = static_cast<double>(i) / count;
    }
    for (const Isa isa : supported_isas()) {
        const auto aim = [&](const std::vector<double>& u0, const std::vector<double>& u1) {
            emission_kernels(isa).aim(
                {count, u0.data(), u1.data(), &whole, cone.data()},
                {{disc_x.data(), disc_y.data()}, {x.data(), y.data(), z.data()}});
            for (std::size_t i = 0; i < count; ++i)
                ASSERT_NEAR(std::hypot(x[i], y[i], z[i]), 1, 1e-6F) << name(isa) << " " << i;
        };
        aim(end, along);
        aim(along, end);
    }
}

TEST(EmissionSamples, MakeNothingWithoutACaster) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 1, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0, 0, 1}, 1)};
    const Scene scene(std::move(desc));
    std::vector<LightPathStart> starts;
    AimedEmission(scene).emit(draw(0, 10, Isa::plain), starts);
    EXPECT_TRUE(starts.empty());
}

}  // namespace
}  // namespace caustics
