#include "experiments/plan/reference_extension.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/scene/scene_reader.h"
#include "experiments/picture/metrics.h"
#include "experiments/plan/reference_cache.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

const std::string scene_file = CAUSTICS_SOURCE_DIR "/tests/experiments/scenes/ball.json";

ReferenceRequest request(std::uint64_t paths, std::uint64_t seed = 1) {
    ReferenceRequest wanted;
    wanted.request = {
        scene_file,
        {},
        parse_method("lighttrace", parameters_node({"paths=" + std::to_string(paths)})),
        seed,
        4};
    const SceneFile file = load_scene(scene_file, {});
    wanted.key = reference_key(wanted.request, file, reference_version(Scene(file.desc)));
    return wanted;
}

Reference rendered(ReferenceCache& cache, const ReferenceRequest& wanted) {
    EXPECT_TRUE(cache.must_render(wanted));
    cache.render(wanted, RunOptions{});
    return *cache.get(wanted);
}

double total(const Film& film) {
    return mean(film, "caustic", PixelMask(film.pixel_count(), true));
}

TEST(ReferenceExtension, BeginsWithTheSamplesThatAreThere) {
    const support::TemporaryFolder folder;
    ReferenceCache cache(std::string(folder / "references"), ReferencePolicy::extend);
    const Reference small = rendered(cache, request(20'000));
    EXPECT_EQ(small.film.metadata.count("extends"), 0U);
    const Reference large = rendered(cache, request(80'000));
    EXPECT_EQ(large.film.metadata.at("extends"), small.key + ".exr");
    // A quarter of what is in it is the first one, pixel by pixel.
    const RunRequest rest = remainder(request(80'000).request, {"", small.film, 20'000});
    EXPECT_EQ(samples_of(rest.method), 60'000U);
    EXPECT_NE(rest.seed, 1U);
    const support::TemporaryFolder other("alone");
    ReferenceCache alone(std::string(other / "references"), ReferencePolicy::extend);
    ReferenceRequest three_quarters = request(60'000, rest.seed);
    const Reference added = rendered(alone, three_quarters);
    for (std::size_t i = 0; i < large.film.pixel_count(); ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(
                large.film.rgb("caustic", i)[c],
                0.25F * small.film.rgb("caustic", i)[c] + 0.75F * added.film.rgb("caustic", i)[c],
                1e-6F);
    // The error falls as one over the root of the samples, and tells how far both are apart.
    EXPECT_NEAR(*small.caustic.standard_error / *large.caustic.standard_error, 2, 0.3);
    const double apart = std::abs(total(small.film) / total(large.film) - 1);
    EXPECT_LT(apart, 4 * *small.caustic.standard_error);
}

TEST(ReferenceExtension, TakesTheLargestOfTheSameKindOnly) {
    const support::TemporaryFolder folder;
    ReferenceCache cache(std::string(folder / "references"), ReferencePolicy::extend);
    const Reference first = rendered(cache, request(1'000));
    const Reference second = rendered(cache, request(3'000));
    rendered(cache, request(50'000));
    rendered(cache, request(2'000, 7));  // another seed
    const SceneFile scene = load_scene(scene_file, {});
    const std::vector<std::filesystem::path> folders = {std::string(folder / "references"),
                                                        std::string(folder / "nowhere")};
    const auto found = find_smaller(folders, request(10'000).request, scene, 1);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->samples, 3'000U);
    EXPECT_EQ(found->film.metadata.at("extends"), first.key + ".exr");
    EXPECT_FALSE(find_smaller(folders, request(1'000).request, scene, 1));
    EXPECT_FALSE(find_smaller(folders, request(10'000, 8).request, scene, 1));
    const SceneFile changed = load_scene(scene_file, {{"/light/intensity", "3"}});
    EXPECT_FALSE(find_smaller(folders, request(10'000).request, changed, 1));
    EXPECT_FALSE(find_smaller(folders, request(10'000).request, scene, 2));
}

// Pictures of version 1 lack what water takes before it comes to an eye in it.
TEST(ReferenceKeys, DifferWhereTheEyeIsInAMediumThatAbsorbs) {
    const auto version = [](const char* name) {
        const std::string scenes = CAUSTICS_SOURCE_DIR "/experiments/scenes/";
        return reference_version(Scene(load_scene(scenes + name, {}).desc));
    };
    EXPECT_EQ(version("pool.json"), 2);
    EXPECT_EQ(version("pool_overhead.json"), 1);
    EXPECT_EQ(version("ball.json"), 1);
}

TEST(ReferenceKeys, NameTheirPictureAndNoOther) {
    const support::TemporaryFolder folder;
    const std::filesystem::path references = folder / "references";
    ReferenceCache cache(references, ReferencePolicy::keep);
    const Reference own = rendered(cache, request(1'000));
    const ReferenceRequest other = request(2'000);
    const std::filesystem::path renamed = references / (other.key + ".exr");
    std::filesystem::copy_file(references / (own.key + ".exr"), renamed);
    try {
        cache.get(other);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what())
                      .find(renamed.string() + ": is the reference " + own.key + ", renamed"),
                  0U)
            << error.what();
    }
}

// Of caustics and of light between surfaces: what pictures of other seeds scatter.
TEST(ReferenceKeys, AreOfPicturesThatKeepTheirErrors) {
    const support::TemporaryFolder folder;
    ReferenceCache cache(std::string(folder / "references"), ReferencePolicy::keep);
    const SceneFile file = load_scene(scene_file, {});
    const Scene scene(file.desc);
    std::vector<Reference> both;
    for (const std::uint64_t seed : {std::uint64_t{1}, std::uint64_t{2}}) {
        ReferenceRequest wanted = request(20'000, seed);
        const std::string without = wanted.key;
        wanted.request.indirect = parse_indirect("lighttrace", parameters_node({"paths=20000"}));
        wanted.key = reference_key(wanted.request, file, reference_version(scene));
        EXPECT_NE(wanted.key, without);
        both.push_back(rendered(cache, wanted));
        EXPECT_EQ(both.back().film.find("stderr.R"), nullptr);
        EXPECT_FALSE(rendered(cache, request(20'000, seed)).indirect);
    }
    ASSERT_TRUE(both[0].indirect && both[0].indirect->standard_error);
    const auto value = [](const Reference& of, std::size_t i) {
        return of.film.rgb("indirect", i).cast<double>().eval();
    };
    double squares = 0, told = 0;
    for (std::size_t i = 0; i < both[0].film.pixel_count(); ++i) {
        squares += (value(both[0], i) - value(both[1], i)).square().sum() / 3;
        for (const Reference& of : both)
            told += std::pow(static_cast<double>((*of.film.find("indirect_stderr.Y"))[i]), 2);
    }
    EXPECT_NEAR(squares / told, 1, 0.25);
}

TEST(ReferenceExtension, IsOnlyDoneWhenAskedFor) {
    const support::TemporaryFolder folder;
    const std::string references = folder / "references";
    ReferenceCache cache(references, ReferencePolicy::extend);
    rendered(cache, request(1'000));
    for (const ReferencePolicy policy : {ReferencePolicy::keep, ReferencePolicy::rebuild}) {
        ReferenceCache anew(references, policy);
        const std::uint64_t paths = policy == ReferencePolicy::keep ? 4'000 : 5'000;
        EXPECT_EQ(rendered(anew, request(paths)).film.metadata.count("extends"), 0U);
    }
}

}  // namespace
}  // namespace caustics::experiments
