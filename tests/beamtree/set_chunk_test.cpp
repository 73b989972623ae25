#include "beamtree/tracing/set_chunk.h"

#include <gtest/gtest.h>

#include "core/math/rng.h"

namespace caustics::beamtree {
namespace {

constexpr std::uint32_t key_count = 500;
constexpr int beams = 3'000;

// A beam whose corners are rays of random keys, or of none.
void add_beam(SetChunk& chunk, std::uint32_t number, Rng& rng) {
    Beam beam;
    beam.corners.fill(Beam::none);
    beam.triangle = number;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t word = rng.next_word();
        const std::uint32_t key = word % 7 == 0 ? Beam::none : word / 7 % key_count;
        std::uint32_t ray = key == Beam::none ? Beam::none : chunk.rays.find(key);
        if (ray == Beam::none) {
            ray = static_cast<std::uint32_t>(chunk.keys.size());
            const Vec3 place(static_cast<float>(key == Beam::none ? number + key_count : key), 0,
                             0);
            chunk.traced.set.rays.push_back({place, Vec3::UnitX()});
            chunk.traced.origins.push_back({place, Vec3::UnitZ()});
            chunk.departures.push_back({Vec3::UnitZ(), static_cast<float>(number)});
            chunk.keys.push_back(key);
            if (key != Beam::none) chunk.rays.add(key, ray);
        }
        beam.corners[i] = ray;
    }
    chunk.traced.set.beams.push_back(beam);
}

struct Joined {
    TracedSet traced;
    std::vector<Departure> departures;
};

Joined in_chunks(int of_beams, int threads) {
    Rng rng(2, Stage::test, 0);
    const auto chunk_count = static_cast<std::size_t>((beams + of_beams - 1) / of_beams);
    std::vector<SetChunk> chunks(chunk_count);
    for (int i = 0; i < beams; ++i)
        add_beam(chunks[static_cast<std::size_t>(i / of_beams)], static_cast<std::uint32_t>(i),
                 rng);
    std::vector<SetChunk*> all;
    for (SetChunk& chunk : chunks) all.push_back(&chunk);
    Joined joined;
    join(all, key_count, threads, joined.traced, joined.departures);
    return joined;
}

// As one thread that makes all beams numbers their rays.
TEST(SetChunk, JoinsAsOneWouldHaveMadeAll) {
    const Joined whole = in_chunks(beams, 1);
    for (const int size : {1, 7, 1'000})
        for (const int threads : {1, 3}) {
            const Joined parts = in_chunks(size, threads);
            ASSERT_EQ(parts.traced.set.rays.size(), whole.traced.set.rays.size());
            ASSERT_EQ(parts.traced.set.beams.size(), whole.traced.set.beams.size());
            for (std::size_t i = 0; i < whole.traced.set.rays.size(); ++i) {
                EXPECT_EQ(parts.traced.set.rays[i].position, whole.traced.set.rays[i].position);
                EXPECT_EQ(parts.traced.origins[i].position, whole.traced.origins[i].position);
                EXPECT_EQ(parts.departures[i].offset, whole.departures[i].offset);
            }
            for (std::size_t i = 0; i < beams; ++i) {
                EXPECT_EQ(parts.traced.set.beams[i].corners, whole.traced.set.beams[i].corners);
                EXPECT_EQ(parts.traced.set.beams[i].triangle, i);
            }
        }
}

TEST(RayIndex, FindsWhatWasAdded) {
    RayIndex index;
    EXPECT_EQ(index.find(0), Beam::none);
    for (std::uint32_t i = 0; i < 10'000; ++i) index.add(1024 * i, i);
    for (std::uint32_t i = 0; i < 10'000; ++i) EXPECT_EQ(index.find(1024 * i), i);
    EXPECT_EQ(index.find(5), Beam::none);
}

}  // namespace
}  // namespace caustics::beamtree
