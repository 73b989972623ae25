#include "experiments/run/picture_light.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "core/reference/light_trace.h"
#include "core/render/renderer.h"
#include "experiments/run/method.h"
#include "tests/support/build_scene.h"

namespace caustics::experiments {
namespace {

// A mirror over a floor and a step beside it; the camera sees both from below the mirror.
SceneDesc floor_and_step() {
    SceneDesc desc;
    desc.shapes = {
        support::horizontal("mirror", 3, 1, false, support::mirror()),
        support::horizontal("floor", 0, 2, true, support::diffuse(0.5F)),
        support::rectangle("step", {1, 0, 0.3}, {0.5, 0, 0}, {0, 1, 0}, support::diffuse(0.8F))};
    desc.lights = {support::point_light({0, 0, 1}, 5)};
    desc.camera.to_world = Transform(Eigen::Translation3d(0, 0, 2.5) *
                                     Eigen::AngleAxisd(std::numbers::pi, Vec3d::UnitX()));
    desc.camera.fov_degrees = 60;
    desc.camera.width = 32;
    desc.camera.height = 32;
    return desc;
}

Rendering traced_picture(const Scene& scene) {
    RunOptions options;
    options.seed = 7;
    const auto estimator = build(scene, LightTraceParams{.paths = 400'000}, options);
    return render(scene, *estimator, options);
}

// The caustic times `factor`, where pixels see the step or not.
void scale(const Scene& scene, float factor, bool on_step, Rendering& picture) {
    Film& film = picture.film;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const double x = static_cast<double>(i % 32) + 0.5;
        const double y = static_cast<double>(i / 32) + 0.5;
        const auto hit =
            scene.intersect({scene.camera().position(), scene.camera().direction(x, y)});
        if (hit && (scene.shape_at(*hit).name == "step") == on_step)
            film.set_rgb("caustic", i, film.rgb("caustic", i) * factor);
    }
}

PictureLight light_of(const Scene& scene, const Rendering& picture, int threads = 1) {
    return picture_light(scene, picture, parse_method("pathtrace", parameters_node({})), 0, threads)
        .value();
}

TEST(PictureLight, IsThatOfLightPathsWhereThePictureIsRight) {
    const Scene scene(floor_and_step());
    const PictureLight light = light_of(scene, traced_picture(scene));
    ASSERT_EQ(light.receivers.size(), 2U);
    EXPECT_EQ(light.receivers[0].receiver, "floor");
    EXPECT_EQ(light.receivers[1].receiver, "step");
    for (const ReceiverLight& one : light.receivers)
        EXPECT_NEAR(one.ratio(), 1, 4 * one.error) << one.receiver;
    EXPECT_LT(light.all.error, 0.015);
    EXPECT_NEAR(light.all.picture, light.receivers[0].picture + light.receivers[1].picture,
                1e-9 * light.all.picture);
    EXPECT_EQ(note_on(light), std::nullopt);
}

TEST(PictureLight, TellsHowMuchAPictureLacksAndWhere) {
    const Scene scene(floor_and_step());
    Rendering picture = traced_picture(scene);
    const PictureLight before = light_of(scene, picture);
    scale(scene, 0.5F, true, picture);
    const PictureLight after = light_of(scene, picture);
    EXPECT_NEAR(after.receivers[0].ratio(), before.receivers[0].ratio(), 1e-12);
    EXPECT_NEAR(after.receivers[1].ratio(), 0.5 * before.receivers[1].ratio(), 1e-6);
    const std::string note = note_on(after).value_or("");
    EXPECT_NE(note.find(": floor 1.0"), std::string::npos) << note;
    EXPECT_NE(note.find(", step 0.5"), std::string::npos) << note;
    scale(scene, 0.87F, false, picture);
    EXPECT_LT(light_of(scene, picture).all.ratio(), after.all.ratio());
}

// A difference of 0.5 % has no note and one of 5 % has one, whichever way.
TEST(PictureLight, IsNotedFromOnePercent) {
    const Scene scene(floor_and_step());
    for (const auto& [factor, noted] :
         {std::pair{1.005F, false}, {0.995F, false}, {1.05F, true}, {0.95F, true}}) {
        Rendering picture = traced_picture(scene);
        scale(scene, factor, true, picture);
        scale(scene, factor, false, picture);
        EXPECT_EQ(note_on(light_of(scene, picture)).has_value(), noted) << factor;
    }
}

// Photons differ less from pixel to pixel than their sum does from seed to seed.
TEST(PictureLight, CountsTheScatterOfPhotons) {
    const Scene scene(floor_and_step());
    const Rendering picture = traced_picture(scene);
    const Method method = parse_method("photonmap", parameters_node({}));
    const auto error = [&](double photons) {
        return picture_light(scene, picture, method, photons, 1)->all.error;
    };
    EXPECT_GT(error(100), 0.1);
    EXPECT_LT(error(1e9), 0.015);
}

TEST(PictureLight, IsTheSameWithAnyThreads) {
    const Scene scene(floor_and_step());
    const Rendering picture = traced_picture(scene);
    EXPECT_EQ(to_json(light_of(scene, picture)), to_json(light_of(scene, picture, 3)));
}

TEST(PictureLight, IsNoneWhereItSaysNothing) {
    const Scene scene(floor_and_step());
    const Rendering picture = traced_picture(scene);
    EXPECT_FALSE(
        picture_light(scene, picture, parse_method("lighttrace", parameters_node({})), 0, 1));
    EXPECT_FALSE(picture_light(scene, picture, parse_method("none", parameters_node({})), 0, 1));
    SceneDesc away = floor_and_step();
    away.camera.to_world = Transform(Eigen::Translation3d(0, 0, 2.5));
    const Scene unseen(away);
    EXPECT_FALSE(
        picture_light(unseen, picture, parse_method("pathtrace", parameters_node({})), 0, 1));
}

}  // namespace
}  // namespace caustics::experiments
