#include "core/scene/transport_hash.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/build_scene.h"

namespace caustics {
namespace {

SceneDesc still_life() {
    SceneDesc desc;
    desc.shapes.push_back(support::horizontal("floor", 0, 3, true, support::diffuse(0.5F)));
    desc.shapes.push_back(support::sphere("ball", {0, 0, 1}, 0.5, support::glass(1.5F)));
    desc.shapes.push_back(support::horizontal("lamp", 4, 0.5, false, support::diffuse(0)));
    desc.shapes.back().radiance = Spectrum(3, 2, 1);
    desc.lights.push_back(support::point_light({-2, -2, 3}, 5));
    return desc;
}

std::uint64_t digest(SceneDesc desc) { return transport_hash(Scene(std::move(desc))); }

TEST(TransportHash, DoesNotSeeTheCameraNorWhatReceiversReflect) {
    SceneDesc other = still_life();
    other.camera.width = 10;
    other.camera.fov_degrees = 20;
    other.sampling.sample_count = 9;
    other.shapes[0].bsdf = support::schlick(0.8F, 0.1F);
    other.shapes[0].name = "ground";
    EXPECT_EQ(digest(still_life()), digest(other));
}

TEST(TransportHash, SeesEverythingThatALightPathMeets) {
    std::vector<SceneDesc> others(11, still_life());
    others[0].shapes[0].bsdf.twosided = true;
    others[1].shapes[0].to_world.translation().z() = 0.25;
    others[2].shapes[1].bsdf = support::glass(1.6F);
    others[3].shapes[1].bsdf = support::mirror();
    others[4].shapes[1] = support::sphere("ball", {0, 0, 1}, 0.6, support::glass(1.5F));
    others[5].shapes[2].radiance = Spectrum(3, 2, 2);
    std::get<PointLight>(others[6].lights[0]).intensity[0] = 6;
    others[7].shapes.pop_back();
    others[8].lights.emplace_back(support::directional_light({0, 0, -1}, 1));
    // The same index in yellow light, parted more or less.
    std::get<Dielectric>(others[9].shapes[1].bsdf.model).int_ior = Ior::abbe(1.5, 60);
    std::get<Dielectric>(others[10].shapes[1].bsdf.model).int_ior = Ior::abbe(1.5, 30);
    std::set<std::uint64_t> digests = {digest(still_life())};
    for (std::size_t i = 0; i < others.size(); ++i)
        EXPECT_TRUE(digests.insert(digest(others[i])).second) << i;
}

TEST(TransportHash, OfAllPhotonsSeesWhereTexturesLie) {
    const auto with_uvs = [](float scale) {
        SceneDesc desc = still_life();
        TriangleMesh triangle;
        triangle.positions = {{-3, -3, 0}, {3, -3, 0}, {0, 3, 0}};
        triangle.uvs = {{0, 0}, {scale, 0}, {0, 1}};
        triangle.triangles = {{0, 1, 2}};
        desc.shapes[0] =
            support::mesh("floor", triangle, Transform::Identity(), support::diffuse(0.5F));
        return Scene(std::move(desc));
    };
    const Scene first = with_uvs(1), other = with_uvs(2);
    EXPECT_NE(whole_transport_hash(first), whole_transport_hash(other));
    EXPECT_EQ(whole_transport_hash(first), whole_transport_hash(with_uvs(1)));
    EXPECT_EQ(transport_hash(first), transport_hash(other));
}

TEST(TransportHash, OfAllPhotonsSeesHowReceiversScatter) {
    const auto whole = [](const Bsdf& floor) {
        SceneDesc desc = still_life();
        desc.shapes[0].bsdf = floor;
        return whole_transport_hash(Scene(std::move(desc)));
    };
    const auto textured = [](std::vector<float> texels, int width, Bitmap::Wrap wrap) {
        Bitmap bitmap;
        bitmap.width = width;
        bitmap.height = static_cast<int>(texels.size()) / width;
        for (const float texel : texels) bitmap.texels.push_back(Spectrum::Constant(texel));
        bitmap.source = texels[0] > texels[1] ? 1 : 2;
        bitmap.wrap = wrap;
        Bsdf bsdf = support::diffuse(0.5F);
        std::get<Diffuse>(bsdf.model).reflectance = bitmap;
        return bsdf;
    };
    const std::vector<Bsdf> floors = {textured({0.1F, 0.2F}, 2, Bitmap::Wrap::repeat),
                                      textured({0.2F, 0.1F}, 2, Bitmap::Wrap::repeat),
                                      textured({0.1F, 0.2F}, 1, Bitmap::Wrap::repeat),
                                      textured({0.1F, 0.2F}, 2, Bitmap::Wrap::mirror),
                                      support::diffuse(0.5F),
                                      support::diffuse(0.6F),
                                      support::schlick(0.8F, 0.1F),
                                      support::schlick(0.8F, 0.2F),
                                      support::schlick(0.7F, 0.1F),
                                      support::phong(0.3F, 0.2F, 30),
                                      support::phong(0.4F, 0.2F, 30),
                                      support::phong(0.3F, 0.1F, 30),
                                      support::phong(0.3F, 0.2F, 31),
                                      support::phong(0.3F, 0.2F, 30, Phong::Model::classic)};
    std::set<std::uint64_t> hashes;
    for (const Bsdf& floor : floors) hashes.insert(whole(floor));
    EXPECT_EQ(hashes.size(), floors.size());
    EXPECT_TRUE(hashes.contains(whole(support::diffuse(0.5F))));
}

}  // namespace
}  // namespace caustics
