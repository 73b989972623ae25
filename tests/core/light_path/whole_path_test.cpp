#include "core/light_path/whole_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/light_path/aimed_emission.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

// What roulette leaves out is in the share of the paths that go on, not in their flux: no path gains any, however often it
// comes to a surface that both mirrors and scatters light. Else few paths would carry most of it.
TEST(WholePath, NeverGainsFlux) {
    Bsdf blend = support::diffuse(0.8F);
    blend.mirror = MirrorPart{0.5F, Spectrum(Spectrum::Constant(0.9F))};
    SceneDesc desc;
    desc.shapes = {support::enclosure(1, blend)};
    desc.lights = {support::point_light({0, 0, 0}, 1)};
    const Scene scene(std::move(desc));
    const AimedEmission emission(scene, Isa::plain, Aim::everywhere);
    LightPathCounts counts;
    std::size_t longest = 0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
        Rng rng(1, Stage::test, i);
        const auto particle = emission.emit(rng);
        ASSERT_TRUE(particle);
        std::vector<Deposit> deposits;
        trace_whole_path(scene, *particle, {}, rng, counts, deposits);
        for (const Deposit& deposit : deposits)
            EXPECT_LE(deposit.flux.sum(), 1.0001F * particle->flux.sum());
        longest = std::max(longest, deposits.size());
    }
    EXPECT_GT(longest, 20U);
}

}  // namespace
}  // namespace caustics
