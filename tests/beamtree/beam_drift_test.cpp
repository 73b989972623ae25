#include "beamtree/tracing/beam_drift.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "beamtree/beams/light_sample.h"
#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

TEST(DriftAccount, AddsRaysAndKeepsTheLargestBend) {
    DriftAccount all{10, 1, 0.2};
    all.add({5, 2, 0.1});
    all.add({1, 0, 0.3});
    EXPECT_EQ(all.rays, 16);
    EXPECT_EQ(all.unknown, 3);
    EXPECT_EQ(all.bend, 0.3);
}

const std::array<Vec3, 3>& places = corners_in_light;

// A triangle of glass in parallel light, with a lid over each of its first corners.
SceneDesc lidded(std::size_t lids) {
    TriangleMesh glass;
    for (const Vec3& place : places) {
        glass.positions.push_back(place);
        glass.normals.push_back(Vec3::UnitZ());
    }
    glass.triangles = {{0, 1, 2}};
    SceneDesc desc;
    desc.shapes = {support::mesh("glass", glass, Transform::Identity(), support::glass(1.5F)),
                   support::horizontal("floor", -1, 3, true, support::diffuse(0.5F))};
    std::get<Dielectric>(desc.shapes[0].bsdf.model).int_ior = Ior::cauchy(1.5, 0.02);
    add_light_and_lids(desc, lids);
    return desc;
}

// The first set's one beam, its rays bent as the middle of the bin is.
Level first_level(const LitCaster& surface) {
    Level level;
    level.event = refraction;
    level.traced.set.beams.resize(1);
    level.traced.set.beams[0].corners = {0, 1, 2, Beam::none};
    for (const Vec3& place : places) {
        const MeshPoint point = surface.bender().at(place, Vec3::UnitZ());
        level.traced.set.rays.push_back({place, point.bent.direction[refraction]});
        level.departures.push_back({Vec3::UnitZ()});
        level.traced.origins.push_back({place, Vec3::UnitZ()});
        level.traced.origins.back().offset = surface.offset(0);
    }
    return level;
}

// By Snell's law; the light arrives with a sine of 0.6.
Vec3 bent(float nm) {
    const double sine = 0.6 / Ior::cauchy(1.5, 0.02).at(nm);
    return Vec3d(-sine, 0, -std::sqrt(1 - sine * sine)).cast<float>();
}

// Parallel light drifts alike at all corners of a plane, so that those that the light does not reach are told exactly
// by one that it does.
TEST(BeamDrift, OfCornersInTheShadeIsThatOfTheOthers) {
    for (std::size_t lids = 0; lids < 3; ++lids) {
        const Scene scene(lidded(lids));
        const std::vector<CasterMesh> casters = caster_meshes(scene, 1);
        const LightSample light =
            drifting(sample_lights(scene, 1, 1), 4, Ior::cauchy(1.5, 0.02)).at(1);
        const LitCaster surface(scene, casters[0], light);
        Level level = first_level(surface);
        const DriftAccount account =
            BeamDrift(scene, casters[0], light).add_to(level, std::vector<bool>(1, true));
        EXPECT_EQ(account.rays, 3);
        EXPECT_EQ(account.unknown, static_cast<double>(lids));
        EXPECT_EQ(level.traced.set.beams[0].offset, 0) << "what is flat is in no ray's way";
        EXPECT_GT(account.bend, 0);
        EXPECT_LT(account.bend, 1e-3);
        for (const std::size_t end : {0U, 1U}) {
            const Vec3 along =
                bent(static_cast<float>(light.places.wavelength_at(end == 0 ? -1 : 1)));
            for (std::size_t i = 0; i < 3; ++i) {
                const VertexRay& ray = level.traced.set.ends[end][i];
                EXPECT_LT((ray.position - places[i]).norm(), 1e-6F);
                EXPECT_LT((ray.direction - along).norm(), 2 * account.bend + 1e-6) << lids;
            }
        }
        EXPECT_GT(
            (level.traced.set.ends[1][0].direction - level.traced.set.ends[0][0].direction).norm(),
            10 * account.bend);
    }
}

}  // namespace
}  // namespace caustics::beamtree
