#include <gtest/gtest.h>

#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"

namespace caustics::photonmap {
namespace {

/// A glass ball over a floor, lit from the side.
Scene ball_scene(const Bsdf& floor) {
    SceneDesc desc;
    desc.shapes = {support::sphere("ball", {0, 0, 0.35}, 0.3, support::glass(1.5F)),
                   support::horizontal("floor", 0, 0.75, true, floor)};
    desc.lights = {support::point_light({-1.2, 0.4, 1.6}, 10)};
    return Scene(std::move(desc));
}

/// Points of the spot, seen from an eye.
std::vector<ReceiverPoint> spot(const Bsdf& floor) {
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 400; ++i) {
        ReceiverPoint point{};
        const int row = i / 20, column = i % 20;
        point.position = Vec3(0.1F + 0.02F * static_cast<float>(column),
                              -0.2F + 0.02F * static_cast<float>(row), 0);
        point.geometric_normal = point.shading_normal = Vec3::UnitZ();
        point.wo = (Vec3(0.3F, -1.7F, 1.3F) - point.position).normalized();
        point.uv = Vec2(0.5F, 0.5F);
        point.bsdf = &floor;
        points.push_back(point);
    }
    return points;
}

struct Answer {
    std::vector<Estimate> radiance;
    Counters counters;
};

Answer radiance(const Scene& scene, const std::vector<ReceiverPoint>& points,
                const PhotonMapParams& params) {
    const auto map = build(scene, params, {});
    const auto context = map->make_context();
    Answer answer;
    answer.radiance.resize(points.size());
    map->radiance(points, answer.radiance, *context);
    context->add_to(answer.counters);
    return answer;
}

TEST(Tables, ShadeTheSameAndCountTheirLookups) {
    for (const Bsdf& floor : {support::schlick(0.8F, 0.1F), support::diffuse(0.5F)}) {
        const Scene scene = ball_scene(floor);
        const std::vector<ReceiverPoint> points = spot(floor);
        const PhotonMapParams without{.photons = 20'000, .nearest = 60};
        PhotonMapParams with = without;
        with.tables = true;
        const Answer plain = radiance(scene, points, without);
        const Answer tables = radiance(scene, points, with);
        float brightest = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Spectrum expected = plain.radiance[i].value;
            brightest = std::max(brightest, expected.maxCoeff());
            EXPECT_TRUE(((tables.radiance[i].value - expected).abs() <= 1e-5F * expected).all())
                << i;
        }
        EXPECT_GT(brightest, 0);
        EXPECT_EQ(plain.counters.count("table_lookups"), 0U);
        // All but the outermost photon of each full gather are looked up.
        EXPECT_LE(tables.counters.at("table_lookups"), tables.counters.at("gathered_photons"));
        EXPECT_GE(tables.counters.at("table_lookups"),
                  tables.counters.at("gathered_photons") - points.size());
        EXPECT_GT(tables.counters.at("table_fillings"), 0U);
        EXPECT_LT(tables.counters.at("table_fillings"), tables.counters.at("table_lookups"));
        // A context that is asked again counts the same again: batches do not lean on each other.
        const Answer again = radiance(scene, points, with);
        EXPECT_EQ(again.counters, tables.counters);
    }
}

}  // namespace
}  // namespace caustics::photonmap
