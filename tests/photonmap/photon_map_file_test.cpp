#include "photonmap/photons/photon_map_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/hash.h"
#include "photon_sets.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/temporary_folder.h"

namespace caustics::photonmap {
namespace {

TracedPhotons traced(std::size_t count) {
    TracedPhotons photons{PhotonStore(count), {}, Spectrum(0.5F, 0.25F, 2)};
    photons.store.append(test::photon_sets(count, 7)[0].photons);
    photons.counts = {.emitted = 9,
                      .aimed = 8,
                      .branched = 3,
                      .reflected = 11,
                      .refracted = 10,
                      .missed = 7,
                      .escaped = 6,
                      .absorbed = 5,
                      .misdirected = 13,
                      .on_black_side = 12,
                      .depth_limited = 4,
                      .stored = count,
                      .dropped = 2};
    return photons;
}

const PhotonOrigin origin = {.transport = 0x1234567890abcdefU,
                             .seed = 77,
                             .emission = PhotonMapParams::Emission::stratified,
                             .interaction = Interaction::split,
                             .max_bounces = 5,
                             .whole_paths = false,
                             .diffuse_bounces = 0,
                             .command = "causticbench render a.json"};

std::string content(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string refusal(const std::filesystem::path& file) {
    try {
        load_photon_map(file);
    } catch (const InputError& error) {
        return error.what();
    }
    return "taken";
}

class PhotonMapFile : public testing::Test {
protected:
    void save(std::size_t count) { save_photon_map(traced(count), origin, file_); }
    support::TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "a.photons";
};

TEST_F(PhotonMapFile, GivesBackWhatWasSaved) {
    // More than a block, one photon, none.
    for (const std::size_t count : {std::size_t{70'000}, std::size_t{1}, std::size_t{0}}) {
        save(count);
        EXPECT_TRUE(is_photon_map(file_));
        const SavedPhotons kept = load_photon_map(file_);
        const TracedPhotons& loaded = kept.photons;
        const TracedPhotons saved = traced(count);
        ASSERT_EQ(loaded.store.size(), count);
        if (count > 0) {
            EXPECT_EQ(std::memcmp(loaded.store.photons().data(), saved.store.photons().data(),
                                  count * sizeof(Photon)),
                      0);
        }
        EXPECT_EQ(kept.origin.transport, origin.transport);
        EXPECT_EQ(kept.origin.seed, 77U);
        EXPECT_EQ(kept.origin.emission, origin.emission);
        EXPECT_EQ(kept.origin.interaction, origin.interaction);
        EXPECT_EQ(kept.origin.max_bounces, 5);
        EXPECT_EQ(kept.origin.command, origin.command);
        EXPECT_TRUE((loaded.flux_unit == saved.flux_unit).all());
        Counters found, expected;
        loaded.counts.add_to(found);
        saved.counts.add_to(expected);
        EXPECT_EQ(found, expected);
    }
}

TEST_F(PhotonMapFile, HasAChecksumThatStandsForItsContent) {
    save(3);
    const std::uint64_t first = photon_map_checksum(file_);
    save_photon_map(traced(3), origin, folder_ / "b.photons");
    EXPECT_EQ(photon_map_checksum(folder_ / "b.photons"), first);
    save(4);
    EXPECT_NE(photon_map_checksum(file_), first);
    write_atomic_file(file_, "a picture, say, and a long one at that");
    EXPECT_THROW(photon_map_checksum(file_), InputError);
    EXPECT_THROW(photon_map_checksum(folder_ / "absent"), InputError);
}

TEST_F(PhotonMapFile, RefusesEveryDamagedByteAndEveryCut) {
    save(3);
    const std::string good = content(file_);
    for (std::size_t i = 0; i < good.size(); ++i) {
        std::string bad = good;
        bad[i] = static_cast<char>(bad[i] ^ 0x10);
        write_atomic_file(file_, bad);
        EXPECT_EQ(refusal(file_).rfind(file_.string() + ": ", 0), 0U) << i;
        write_atomic_file(file_, std::string_view(good).substr(0, i));
        EXPECT_EQ(refusal(file_).rfind(file_.string() + ": ", 0), 0U) << i;
    }
    write_atomic_file(file_, good + "x");
    EXPECT_NE(refusal(file_).find("checksum"), std::string::npos);
    write_atomic_file(file_, good);
    EXPECT_EQ(refusal(file_), "taken");
}

TEST_F(PhotonMapFile, RefusesPhotonsThatAreNoLightThoughTheChecksumFits) {
    const auto refusal_with = [&](const auto& spoil) {
        TracedPhotons photons = traced(3);
        spoil(photons);
        save_photon_map(photons, origin, file_);
        return refusal(file_);
    };
    using Limits = std::numeric_limits<float>;
    for (const float place : {Limits::quiet_NaN(), Limits::infinity(), 1e19F}) {
        const std::string message = refusal_with(
            [&](TracedPhotons& photons) { photons.store.photons()[2].position[1] = place; });
        EXPECT_EQ(message, file_.string() +
                               ": is damaged: the place of photon 2 is not finite or "
                               "beyond every scene");
    }
    for (const float unit : {Limits::quiet_NaN(), Limits::infinity(), -1.0F})
        EXPECT_NE(refusal_with([&](TracedPhotons& photons) {
                      photons.flux_unit[0] = unit;
                  }).find("a.photons: is damaged: the unit of its photons' flux"),
                  std::string::npos);
    const std::string bright = refusal_with([](TracedPhotons& photons) {
        photons.flux_unit[0] = 1e30F;
        photons.store.photons()[1].energy = {{255, 0, 0}, 255};
    });
    EXPECT_NE(bright.find("the flux of photon 1 is not finite"), std::string::npos) << bright;
}

/// The same content as an older version had it: version 3 without what a global map adds, version 2 with 12
/// counts, and photons whose surfaces are not known.
std::string as_version(char version, std::string text) {
    const std::size_t numbers = std::string_view("causticbench photon map\n").size() + 8;
    text[numbers - 8] = version;
    std::uint32_t length = 0;
    std::memcpy(&length, text.data() + numbers - 4, sizeof length);
    const std::size_t kind = numbers + 2 * 8 + 3 * 4;
    text.erase(kind, 8);
    length -= 8;
    if (version == 2) {
        text.erase(kind + 12 * 8, 8);
        length -= 8;
    }
    std::memcpy(text.data() + numbers - 4, &length, sizeof length);
    text.resize(text.size() - 8);
    const std::uint64_t hash = fnv1a(text);
    text.append(reinterpret_cast<const char*>(&hash), sizeof hash);
    return text;
}

TEST_F(PhotonMapFile, OfOlderVersionsIsRead) {
    save(100);
    const std::string content_now = content(file_);
    const SavedPhotons now = load_photon_map(file_);
    EXPECT_EQ(now.version, 4U);
    for (const char version : {char{2}, char{3}}) {
        write_atomic_file(file_, as_version(version, content_now));
        const SavedPhotons before = load_photon_map(file_);
        EXPECT_EQ(before.version, static_cast<std::uint32_t>(version));
        EXPECT_EQ(before.photons.counts.misdirected, version == 2 ? 0U : 13U);
        EXPECT_EQ(before.photons.counts.dropped, now.photons.counts.dropped);
        EXPECT_FALSE(before.origin.whole_paths);
        EXPECT_TRUE((before.photons.flux_unit == now.photons.flux_unit).all());
        EXPECT_EQ(before.origin.command, now.origin.command);
        EXPECT_EQ(std::memcmp(before.photons.store.photons().data(),
                              now.photons.store.photons().data(), now.photons.store.bytes()),
                  0);
    }
}

// Whole numbers of the header that an int does not hold, and choices that are none.
TEST_F(PhotonMapFile, RefusesNumbersWithoutSense) {
    save(3);
    const std::string good = content(file_);
    const std::size_t numbers = std::string_view("causticbench photon map\n").size() + 8 + 2 * 8;
    const auto refusal_with = [&](std::size_t word, std::uint32_t value) {
        std::string bad = good;
        std::memcpy(bad.data() + numbers + 4 * word, &value, sizeof value);
        write_atomic_file(file_, bad);
        return refusal(file_);
    };
    // Emission, interaction, max_bounces, whole_paths, diffuse_bounces.
    const std::uint32_t beyond[] = {2, 2, 0x80000000U, 2, 0x80000000U};
    for (std::size_t word = 0; word < 5; ++word)
        EXPECT_EQ(refusal_with(word, beyond[word]),
                  file_.string() + ": is damaged: its header has no sense")
            << word;
    EXPECT_NE(refusal_with(2, 0x7fffffffU).find("checksum"), std::string::npos)
        << "the largest int has sense, but was not written";
}

TEST_F(PhotonMapFile, RefusesAnotherNumberOfPhotonsThanItsCounts) {
    for (const std::uint64_t counted : {2U, 4U}) {
        TracedPhotons photons = traced(3);
        photons.counts.stored = counted;
        save_photon_map(photons, origin, file_);
        EXPECT_NE(refusal(file_).find("is damaged"), std::string::npos) << counted;
    }
}

TEST_F(PhotonMapFile, HasNoChecksumWhereItIsCutShort) {
    save(3);
    const std::string good = content(file_);
    const std::size_t start = std::string_view("causticbench photon map\n").size() + 4;
    for (const std::size_t left : {0U, 7U}) {
        write_atomic_file(file_, std::string_view(good).substr(0, start + left));
        try {
            photon_map_checksum(file_);
            ADD_FAILURE() << left;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("cut short"), std::string::npos);
        }
    }
}

// An old map still gives a picture, and the record says that it is old.
TEST_F(PhotonMapFile, OfAnOlderVersionIsNamedInTheReport) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("mirror", 0, 1, true, support::mirror()),
                   support::horizontal("ceiling", 2, 4, false, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0, 0, 1}, 1)};
    const Scene scene(std::move(desc));
    build(scene, PhotonMapParams{.photons = 100, .save = file_}, {});
    const std::string content_now = content(file_);
    const auto version_of = [&](const std::string& text) {
        write_atomic_file(file_, text);
        const BuildReport report =
            build(scene, PhotonMapParams{.photons = 0, .load = file_}, {})->build_report();
        EXPECT_EQ(report.counters.at("photons_stored"), 100U);
        const auto found = report.resolved.find("photon_map_version");
        return found == report.resolved.end() ? 0.0 : found->second;
    };
    EXPECT_EQ(version_of(content_now), 0);
    EXPECT_EQ(version_of(as_version(3, content_now)), 0) << "its photons' surfaces are known";
    EXPECT_EQ(version_of(as_version(2, content_now)), 2);
}

TEST_F(PhotonMapFile, NamesWhatIsWrong) {
    write_atomic_file(file_, "a picture, say, and a long one at that");
    EXPECT_FALSE(is_photon_map(file_));
    EXPECT_NE(refusal(file_).find("no photon map"), std::string::npos);
    EXPECT_NE(refusal(folder_ / "absent").find("cannot be read"), std::string::npos);
    save(3);
    std::string text = content(file_);
    text[24] = 1;
    write_atomic_file(file_, text);
    EXPECT_NE(refusal(file_).find("version 1 (known: 2 to 4)"), std::string::npos)
        << refusal(file_);
    save(3);
    text = content(file_);
    write_atomic_file(file_, std::string_view(text).substr(0, text.size() - 30));
    EXPECT_NE(refusal(file_).find("cut short"), std::string::npos);
}

}  // namespace
}  // namespace caustics::photonmap
