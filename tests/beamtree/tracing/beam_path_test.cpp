#include "beamtree/tracing/beam_path.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "beamtree/tracing/beam_drift.h"
#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

constexpr float depth = 0.5F;
constexpr float absorption = 1.5F;  // of the glass [1/m]
const std::array<Vec3, 3>& places = corners_in_light;

TriangleMesh level_triangle(float z, float half) {
    TriangleMesh mesh;
    for (const Vec3& at :
         {Vec3(-half, -half, z), Vec3(3 * half, -half, z), Vec3(-half, 3 * half, z)}) {
        mesh.positions.push_back(at);
        mesh.normals.push_back(Vec3::UnitZ());
    }
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

/// Glass between two surfaces, in parallel light; with a lid over each of the first corners.
SceneDesc slab(std::size_t lids) {
    const Bsdf glass = support::glass(1.5F, 1, Spectrum::Constant(absorption));
    SceneDesc desc;
    desc.shapes = {support::mesh("top", level_triangle(0, 3), Transform::Identity(), glass),
                   support::rectangle("bottom", {0, 0, -static_cast<double>(depth)}, {0, 9, 0},
                                      {9, 0, 0}, glass),
                   support::horizontal("floor", -1, 9, true, support::diffuse(0.5F))};
    for (std::size_t i = 0; i < 2; ++i)
        std::get<Dielectric>(desc.shapes[i].bsdf.model).int_ior = Ior::cauchy(1.5, 0.02);
    add_light_and_lids(desc, lids);
    return desc;
}

/// The light of the places behind the first surface and behind both, as the middle of the bin goes.
struct Slab {
    Scene scene;
    std::vector<CasterMesh> casters;
    LightSample light;
    LitCaster surface;
    Level first;
    Level second;

    explicit Slab(std::size_t lids)
        : scene(slab(lids)),
          casters(caster_meshes(scene, 1)),
          light(drifting(sample_lights(scene, 1, 1), 4, Ior::cauchy(1.5, 0.02)).at(1)),
          surface(scene, casters[0], light) {
        first.event = second.event = refraction;
        second.parent = &first;
        second.parents = {0};
        Beam beam;
        beam.corners = {0, 1, 2, Beam::none};
        first.traced.set.beams = second.traced.set.beams = {beam};
        for (const Vec3& place : places) {
            const MeshPoint point = surface.bender().at(place, Vec3::UnitZ());
            const VertexRay ray{place, point.bent.direction[refraction]};
            const Departure from{Vec3::UnitZ(), 1e-4F,
                                 surface.bender().medium_after(Vec3::UnitZ(), ray.direction)};
            first.traced.set.rays.push_back(ray);
            first.departures.push_back(from);
            RayOrigin origin{place, Vec3::UnitZ()};
            origin.offset = 1e-4F;
            first.traced.origins.push_back(origin);
            const RayArrival arrival = land(scene, ray, from, light.bin.nm);
            EXPECT_EQ(arrival.shape, 1U);
            second.traced.set.rays.push_back({arrival.position, arrival.direction[refraction]});
            second.traced.origins.push_back(origin);
            second.departures.push_back(arrival.after(refraction));
            second.places = {arrival};
        }
    }
};

// Of the glass's light as far as it goes through it, at an angle by Snell's law.
TEST(BeamPath, TellsWhatTheMediaOnItHaveLeft) {
    const Slab slab(0);
    const double sine = 0.6 / Ior::cauchy(1.5, 0.02).at(slab.light.bin.nm);
    const double way = static_cast<double>(depth) / std::sqrt(1 - sine * sine);
    const double left = std::exp(-static_cast<double>(absorption) * way);
    const PathPoint in_glass =
        Path(slab.scene, slab.surface, slab.first, 0).from(slab.first.traced.origins[1]);
    ASSERT_TRUE(in_glass.alive);
    EXPECT_EQ(in_glass.origin.left, 1);
    const PathPoint behind =
        Path(slab.scene, slab.surface, slab.second, 0).from(slab.second.traced.origins[1]);
    ASSERT_TRUE(behind.alive);
    EXPECT_NEAR(behind.origin.left, left, 1e-4);
    EXPECT_LT((behind.ray.position - slab.second.traced.set.rays[1].position).norm(), 1e-5F);
}

TEST(BeamPath, BeginsInTheMiddleOfAPiece) {
    const Slab slab(0);
    const Path path(slab.scene, slab.surface, slab.second, 0);
    Piece piece;
    for (std::size_t i = 0; i < 3; ++i) piece[i] = path.from(slab.second.traced.origins[i]);
    const PathPoint middle = path.middle(piece);
    ASSERT_TRUE(middle.alive);
    EXPECT_LT((middle.origin.position - (places[0] + places[1] + places[2]) / 3).norm(), 1e-6F);
    // Parallel light behind parallel planes.
    const Vec3 moved = slab.second.traced.set.rays[0].position - places[0];
    EXPECT_LT((middle.ray.position - middle.origin.position - moved).norm(), 1e-5F);
}

// Behind two surfaces places drift as well, of parallel light alike at all corners: those in the shade are told by the others.
TEST(BeamDrift, OfPlacesInTheShadeIsThatOfTheOthers) {
    std::array<Vec3, 2> drift;
    for (std::size_t lids = 0; lids < 3; ++lids) {
        Slab slab(lids);
        const DriftAccount account = BeamDrift(slab.scene, slab.casters[0], slab.light)
                                         .add_to(slab.second, std::vector<bool>(1, true));
        EXPECT_EQ(account.unknown, static_cast<double>(lids));
        const BeamSet& set = slab.second.traced.set;
        for (const std::size_t end : {0U, 1U}) {
            if (lids == 0) drift[end] = set.ends[end][0].position - set.rays[0].position;
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_LT((set.ends[end][i].position - set.rays[i].position - drift[end]).norm(),
                          0.02F * drift[end].norm())
                    << lids << " of corner " << i;
        }
    }
    EXPECT_GT(drift[0].norm(), 1e-4F);
    EXPECT_LT(drift[0].dot(drift[1]), 0);
}

}  // namespace
}  // namespace caustics::beamtree
