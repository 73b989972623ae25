#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/method/none.h"
#include "core/render/renderer.h"
#include "photonmap/global_photon_map.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

using photonmap::GlobalMapParams;

struct Picture {
    Film film;
    Counters counters;

    double saved_share() const {
        const auto saved = static_cast<double>(counters.at("shadow_rays_saved"));
        return saved / (saved + static_cast<double>(counters.at("shadow_rays")));
    }
    double mean() const {
        double sum = 0;
        for (std::size_t i = 0; i < film.pixel_count(); ++i)
            sum += static_cast<double>(film.rgb("direct", i).mean());
        return sum / static_cast<double>(film.pixel_count());
    }
};

Picture picture(const Scene& scene, std::uint64_t shadow_photons, int threads = 1,
                Isa isa = widest_isa()) {
    RunOptions options;
    options.threads = threads;
    options.isa = isa;
    options.samples_per_pixel = 4;
    const auto caustic = build(scene, NoneParams{}, options);
    const auto indirect =
        build(scene, GlobalMapParams{.photons = 500, .gather = 0, .shadow_photons = shadow_photons},
              options);
    Rendering rendering = render(scene, *caustic, options, indirect.get());
    return {std::move(rendering.film), std::move(rendering.report.counters)};
}

// Mean absolute difference of the direct layer, of the mean of the second.
double direct_difference(const Picture& a, const Picture& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.film.pixel_count(); ++i)
        sum +=
            static_cast<double>((a.film.rgb("direct", i) - b.film.rgb("direct", i)).abs().mean());
    return sum / static_cast<double>(a.film.pixel_count()) / b.mean();
}

// A floor seen from above, and what lies over it.
SceneDesc floor_below(const std::vector<Shape>& above) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 1, true, support::diffuse(0.6F))};
    desc.shapes.insert(desc.shapes.end(), above.begin(), above.end());
    desc.lights = {support::point_light({0.2, 0.1, 2}, 3)};
    desc.camera = support::camera({0, -1.2, 0.9}, {0, 0, 0}, Vec3d::UnitZ(), 50, 32, 24);
    return desc;
}

Shape lamp() {
    Shape shape = support::horizontal("lamp", 2.5, 0.2, false, support::diffuse(0));
    shape.radiance = Spectrum(Spectrum::Constant(10));
    return shape;
}

TEST(ShadowPhotons, SpareTheRaysOfAFloorInTheLight) {
    for (const bool has_extent : {false, true}) {
        SceneDesc desc = floor_below({});
        if (has_extent) {
            desc.lights.clear();
            desc.shapes.push_back(lamp());
        }
        const Scene scene(std::move(desc));
        const Picture all = picture(scene, 0);
        const Picture spared = picture(scene, 100'000);
        EXPECT_GT(spared.saved_share(), 0.95);
        EXPECT_EQ(*spared.film.find("direct.R"), *all.film.find("direct.R"));
        EXPECT_GT(all.mean(), 0);
        EXPECT_FALSE(all.counters.contains("shadow_rays"));
    }
}

TEST(ShadowPhotons, SpareTheRaysOfAFloorInTheDark) {
    const Scene scene(
        floor_below({support::horizontal("plate", 1.5, 3, true, support::diffuse(0.5F, true))}));
    const Picture dark = picture(scene, 200'000);
    EXPECT_GT(dark.saved_share(), 0.95);
    EXPECT_EQ(dark.mean(), 0);
}

// In half shadow and along its edge rays are traced: what is wrong is narrower than photons lie apart.
TEST(ShadowPhotons, LeaveRaysToTheEdgesOfShadows) {
    const Scene scene(
        floor_below({support::sphere("ball", {0, 0, 0.5}, 0.3, support::diffuse(0.5F))}));
    const Picture all = picture(scene, 0);
    double least_saved = 0;
    for (const std::uint64_t rays : {std::uint64_t{20'000}, std::uint64_t{500'000}}) {
        const Picture spared = picture(scene, rays);
        EXPECT_GT(spared.counters.at("shadow_rays"), 0U);
        EXPECT_GT(spared.saved_share(), least_saved);
        EXPECT_LT(direct_difference(spared, all), 0.005);
        least_saved = spared.saved_share();
    }
    EXPECT_GT(least_saved, 0.9);
}

// Too few photons miss a shadow that is narrower than they lie apart, and the picture shows it.
TEST(ShadowPhotons, MissWhatIsNarrowerThanTheyLieApart) {
    const Scene scene(
        floor_below({support::sphere("bead", {0, 0, 0.3}, 0.025, support::diffuse(0.5F))}));
    const Picture all = picture(scene, 0);
    const double few = direct_difference(picture(scene, 500), all);
    EXPECT_GT(few, 0);
    EXPECT_LT(direct_difference(picture(scene, 500'000), all), 0.2 * few);
}

// Glass casts a full shadow, as shadow rays see it.
TEST(ShadowPhotons, LieBehindGlass) {
    const Scene scene(
        floor_below({support::sphere("ball", {0, 0, 0.6}, 0.5, support::glass(1.5F))}));
    EXPECT_LT(direct_difference(picture(scene, 300'000), picture(scene, 0)), 0.01);
}

TEST(ShadowPhotons, AreTheSameByThreadsAndInstructionSets) {
    const Scene scene(
        floor_below({support::sphere("ball", {0, 0, 0.5}, 0.3, support::diffuse(0.5F))}));
    const Picture one = picture(scene, 20'000);
    for (const Isa isa : supported_isas()) {
        const Picture other = picture(scene, 20'000, 3, isa);
        EXPECT_EQ(*one.film.find("direct.R"), *other.film.find("direct.R"));
        EXPECT_EQ(one.counters.at("shadow_rays"), other.counters.at("shadow_rays"));
    }
}

TEST(ShadowPhotons, RefuseTransparentShadows) {
    const Scene scene(floor_below({}));
    const auto caustic = build(scene, NoneParams{.shadows = Shadows::transparent}, {});
    const auto indirect =
        build(scene, GlobalMapParams{.photons = 500, .gather = 0, .shadow_photons = 100}, {});
    EXPECT_THROW(render(scene, *caustic, {}, indirect.get()), InputError);
}

}  // namespace
}  // namespace caustics
