#include "photonmap/photon_dots.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/build_scene.h"

namespace caustics::photonmap {
namespace {

/// A floor seen from 2 m above, so that a pixel is 2 m x sqrt(pixel_area) wide.
SceneDesc floor_from_above() {
    SceneDesc desc;
    desc.shapes.push_back(support::horizontal("floor", 0, 2, true, support::diffuse(0.5F)));
    desc.camera = support::camera({0, 0, 2}, {0, 0, 0}, {0, 1, 0}, 60, 32, 32);
    return desc;
}

TracedPhotons at(const std::vector<Vec3>& places, const Spectrum& energy) {
    TracedPhotons photons{PhotonStore(places.size()), {}, Spectrum::Ones()};
    photons.counts.emitted = photons.counts.stored = places.size();
    for (const Vec3& p : places) {
        const DirectionCode up = encode_direction(Vec3::UnitZ());
        const Photon photon{{p.x(), p.y(), p.z()}, encode_rgbe(energy), up.theta, up.phi, 0};
        photons.store.append({&photon, 1});
    }
    return photons;
}

TEST(PhotonDots, AreDiscsOfPixelsAsBrightAsTheLogarithmOfTheirNumber) {
    const Scene scene(floor_from_above());
    const Vec3 one(0.5F, 0, 0), three(-0.5F, 0, 0);
    const Spectrum red(0.5F, 0.25F, 0);
    const auto dots = photon_dots(scene, at({one, three, three, three}, red), 2, Isa::plain);
    const float distance = Vec2(0.5F, 2).norm();
    const float radius = 2 * distance * std::sqrt(static_cast<float>(scene.camera().pixel_area()));
    std::vector<ReceiverPoint> points;
    for (const Vec3& p : {one, three, Vec3(0.5F, 0.98F * radius, 0), Vec3(0.5F, 1.1F * radius, 0)})
        points.push_back(support::probe(scene, 0, p.cast<double>(), Vec3d::UnitZ(), 0, 0));
    std::vector<Estimate> seen(points.size());
    dots->radiance(points, seen, *dots->make_context());
    const Spectrum colour(1, 0.5F, 0);
    EXPECT_TRUE(seen[0].value.isApprox(colour));
    EXPECT_TRUE(seen[1].value.isApprox(colour * (1 + std::log2(3.0F))));
    EXPECT_TRUE(seen[2].value.isApprox(colour));
    EXPECT_TRUE(is_black(seen[3].value));
}

}  // namespace
}  // namespace caustics::photonmap
