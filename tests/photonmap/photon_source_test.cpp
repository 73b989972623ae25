#include "photonmap/photons/photon_source.h"
#include "photonmap/global_photon_map.h"
#include "photonmap/photon_map.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/render/renderer.h"
#include "tests/support/build_scene.h"
#include "tests/support/temporary_folder.h"

namespace caustics::photonmap {
namespace {

/// A glass ball over a glossy floor.
SceneDesc still_life() {
    SceneDesc desc;
    desc.shapes.push_back(support::horizontal("floor", 0, 2, true, support::schlick(0.6F, 0.3F)));
    desc.shapes.push_back(support::sphere("ball", {0, 0, 0.6}, 0.5, support::glass(1.5F)));
    desc.lights.push_back(support::point_light({-0.5, -0.4, 3}, 5));
    desc.camera = support::camera({1, -2, 1.5}, {0, 0, 0}, {0, 0, 1}, 50, 24, 18);
    return desc;
}

RunOptions options() {
    RunOptions options;
    options.seed = 3;
    options.samples_per_pixel = 2;
    options.origin = "a test";
    return options;
}

Film picture(SceneDesc desc, const PhotonMapParams& params, RunOptions run = options()) {
    const Scene scene(std::move(desc));
    const auto map = build(scene, params, run);
    return render(scene, *map, run).film;
}

void expect_same(const Film& a, const Film& b) {
    ASSERT_EQ(a.planes().size(), b.planes().size());
    for (std::size_t i = 0; i < a.planes().size(); ++i)
        EXPECT_EQ(a.planes()[i].values, b.planes()[i].values) << i;
    double light = 0;
    for (std::size_t i = 0; i < a.pixel_count(); ++i)
        light += static_cast<double>(a.rgb("caustic", i).sum());
    EXPECT_GT(light, 0);
}

class KeptPhotons : public testing::Test {
protected:
    /// Traces `params` once for the still life and compares every picture of `desc` made from the
    /// file with the one traced anew.
    void expect_same_when_loaded(SceneDesc desc, PhotonMapParams params) {
        params.save = file_;
        const Scene scene(still_life());
        build(scene, params, options());
        params.save.clear();
        PhotonMapParams loading = params;
        loading.load = file_;
        loading.photons = loading.emitted = 0;
        RunOptions other = options();
        other.threads = 2;
        expect_same(picture(desc, params), picture(desc, loading, other));
    }
    std::string refusal(SceneDesc desc) {
        try {
            picture(std::move(desc), {.photons = 0, .load = file_});
        } catch (const InputError& error) {
            return error.what();
        }
        return "taken";
    }
    support::TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "a.photons";
};

TEST_F(KeptPhotons, GiveThePictureThatTracingGives) {
    expect_same_when_loaded(still_life(), {.photons = 3000});
    for (const TreeKind tree : {TreeKind::unbalanced, TreeKind::packed})
        expect_same_when_loaded(
            still_life(),
            {.photons = 3000, .kernel = KernelKind::point, .tree = tree, .nearest = 7});
    expect_same_when_loaded(still_life(), {.photons = 0, .emitted = 5000});
    expect_same_when_loaded(still_life(), {.photons = 3000,
                                           .emission = PhotonMapParams::Emission::stratified,
                                           .interaction = Interaction::split});
}

TEST_F(KeptPhotons, ServeAnotherCameraAndAnotherReceiver) {
    SceneDesc camera = still_life();
    camera.camera = support::camera({-1, -2, 2.5}, {0, 0, 0.2}, {0, 0, 1}, 35, 20, 20);
    expect_same_when_loaded(camera, {.photons = 3000});
    SceneDesc glossy = still_life();
    glossy.shapes[0].bsdf = support::schlick(0.6F, 0.05F);
    expect_same_when_loaded(glossy, {.photons = 3000});
    SceneDesc matt = still_life();
    matt.shapes[0].bsdf = support::diffuse(0.3F);
    expect_same_when_loaded(matt, {.photons = 3000});
}

TEST_F(KeptPhotons, AreRefusedWhereTheLightGoesElsewhere) {
    expect_same_when_loaded(still_life(), {.photons = 3000});
    std::vector<SceneDesc> others(5, still_life());
    others[0].shapes[1].bsdf = support::glass(1.51F);
    std::get<PointLight>(others[1].lights[0]).position.x() += 0.01F;
    others[2].shapes[0].to_world.translation().z() -= 0.01;
    others[3].shapes.push_back(
        support::horizontal("shelf", 0.01, 0.1, true, support::diffuse(0.5F)));
    others[4].shapes[0].bsdf.twosided = true;
    for (std::size_t i = 0; i < others.size(); ++i)
        EXPECT_NE(refusal(others[i]).find("those of another scene"), std::string::npos) << i;
}

TEST_F(KeptPhotons, TellHowTheyWereTraced) {
    const Scene scene(still_life());
    const auto traced =
        build(scene, PhotonMapParams{.photons = 500, .max_bounces = 4, .save = file_}, options());
    const auto loaded = build(scene, PhotonMapParams{.photons = 0, .load = file_}, {});
    EXPECT_EQ(loaded->build_report().counters, traced->build_report().counters);
    EXPECT_EQ(loaded->build_report().resolved.at("max_bounces"), 4);
    EXPECT_EQ(load_photon_map(file_).origin.command, "a test");
}

TEST_F(KeptPhotons, BeginWithTryingTheFileToWrite) {
    const Scene scene(still_life());
    std::vector<std::string> phases;
    RunOptions run = options();
    run.begin_phase = [&](std::string_view phase) { phases.emplace_back(phase); };
    const PhotonMapParams params{.photons = 10, .save = folder_ / "absent" / "a.photons"};
    EXPECT_THROW(build(scene, params, run), InputError);
    EXPECT_TRUE(phases.empty());
    build(scene, PhotonMapParams{.photons = 10, .save = file_}, run);
    build(scene, PhotonMapParams{.photons = 0, .load = file_}, run);
    EXPECT_EQ(phases, (std::vector<std::string>{"trace", "save", "balance", "widths", "load",
                                                "balance", "widths"}));
}

Film indirect_picture(SceneDesc desc, const GlobalMapParams& params, RunOptions run = options()) {
    const Scene scene(std::move(desc));
    const auto none = build(scene, PhotonMapParams{.photons = 10}, run);
    const auto indirect = build(scene, params, run);
    return render(scene, *none, run, indirect.get()).film;
}

TEST_F(KeptPhotons, OfAllSurfacesGiveThePictureThatTracingGives) {
    for (const int gather : {0, 8}) {
        GlobalMapParams params{.photons = 2000, .gather = gather, .save = file_};
        params.diffuse_bounces = 3;
        const Film traced = indirect_picture(still_life(), params);
        GlobalMapParams loading{.gather = gather, .load = file_};
        RunOptions other = options();
        other.threads = 2;
        const Film loaded = indirect_picture(still_life(), loading, other);
        EXPECT_EQ(*traced.find("indirect.R"), *loaded.find("indirect.R"));
        const SavedPhotons saved = load_photon_map(file_);
        EXPECT_TRUE(saved.origin.whole_paths);
        // The last receiver is the one that gathers.
        EXPECT_EQ(saved.origin.diffuse_bounces, gather > 0 ? 2 : 3);
    }
}

TEST_F(KeptPhotons, OfAllSurfacesDependOnWhatReceiversReflect) {
    indirect_picture(still_life(), {.photons = 200, .save = file_});
    const auto refusal_of_whole = [&](SceneDesc desc) -> std::string {
        try {
            indirect_picture(std::move(desc), {.load = file_});
        } catch (const InputError& error) {
            return error.what();
        }
        return "taken";
    };
    EXPECT_EQ(refusal_of_whole(still_life()), "taken");
    SceneDesc darker = still_life();
    darker.shapes[0].bsdf = support::schlick(0.5F, 0.3F);
    EXPECT_NE(refusal_of_whole(darker).find("another scene: lights, surfaces"), std::string::npos);
    SceneDesc smoother = still_life();
    smoother.shapes[0].bsdf = support::schlick(0.6F, 0.2F);
    EXPECT_NE(refusal_of_whole(smoother).find("another scene"), std::string::npos);
    EXPECT_NE(refusal(still_life()).find("a map of all surfaces"), std::string::npos);
    const Scene scene(still_life());
    build(scene, PhotonMapParams{.photons = 10, .save = file_}, options());
    EXPECT_NE(refusal_of_whole(still_life()).find("a map of caustics alone"), std::string::npos);
}

}  // namespace
}  // namespace caustics::photonmap
