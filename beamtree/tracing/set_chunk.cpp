#include "beamtree/tracing/set_chunk.h"

#include "core/base/parallel.h"

namespace caustics::beamtree {
namespace {

/// Where a chunk's rays and beams go.
struct Target {
    std::vector<std::uint32_t> number;  ///< one a ray
    std::uint32_t first_ray = 0;        ///< of those that come first in this chunk
    std::size_t first_beam = 0;
};

// Numbers all rays; returns how many there are.
std::uint32_t number_rays(std::span<SetChunk* const> chunks, std::size_t key_count,
                          std::vector<Target>& targets) {
    std::vector<std::uint32_t> of_key(key_count, Beam::none);
    std::uint32_t count = 0;
    std::size_t beams = 0;
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        Target& target = targets[i];
        target.first_ray = count;
        target.first_beam = beams;
        beams += chunks[i]->traced.set.beams.size();
        target.number.reserve(chunks[i]->keys.size());
        for (const std::uint32_t key : chunks[i]->keys) {
            const bool known = key != Beam::none && of_key[key] != Beam::none;
            if (!known && key != Beam::none) of_key[key] = count;
            target.number.push_back(known ? of_key[key] : count++);
        }
    }
    return count;
}

}  // namespace

std::uint32_t RayIndex::find(std::uint32_t key) const {
    if (places_.empty()) return Beam::none;
    const std::size_t mask = places_.size() - 1;
    for (std::size_t i = hash(key) & mask; places_[i].ray != Beam::none; i = (i + 1) & mask)
        if (places_[i].key == key) return places_[i].ray;
    return Beam::none;
}

void RayIndex::add(std::uint32_t key, std::uint32_t ray) {
    if (2 * (count_ + 1) > places_.size()) grow();
    const std::size_t mask = places_.size() - 1;
    std::size_t i = hash(key) & mask;
    while (places_[i].ray != Beam::none) i = (i + 1) & mask;
    places_[i] = {key, ray};
    ++count_;
}

void RayIndex::grow() {
    std::vector<Place> old(std::max<std::size_t>(64, 2 * places_.size()));
    old.swap(places_);
    count_ = 0;
    for (const Place& place : old)
        if (place.ray != Beam::none) add(place.key, place.ray);
}

void join(std::span<SetChunk* const> chunks, std::size_t key_count, int threads, TracedSet& traced,
          std::vector<Departure>& departures) {
    std::vector<Target> targets(chunks.size());
    const std::uint32_t rays = number_rays(chunks, key_count, targets);
    BeamSet& set = traced.set;
    set.rays.resize(rays);
    traced.origins.resize(rays);
    std::size_t beams = 0;
    for (const SetChunk* chunk : chunks) {
        beams += chunk->traced.set.beams.size();
        if (!chunk->departures.empty()) departures.resize(rays);
    }
    set.beams.resize(beams);
    parallel_chunks(threads, chunks.size(), 1, [&](const Chunk& which) {
        const SetChunk& from = *chunks[which.index];
        const Target& target = targets[which.index];
        for (std::size_t i = 0; i < target.number.size(); ++i) {
            const std::uint32_t number = target.number[i];
            if (number < target.first_ray) continue;
            set.rays[number] = from.traced.set.rays[i];
            traced.origins[number] = from.traced.origins[i];
            if (!from.departures.empty()) departures[number] = from.departures[i];
        }
        for (std::size_t i = 0; i < from.traced.set.beams.size(); ++i) {
            Beam& beam = set.beams[target.first_beam + i];
            beam = from.traced.set.beams[i];
            for (std::uint32_t& corner : beam.corners)
                if (corner != Beam::none) corner = target.number[corner];
        }
    });
}

}  // namespace caustics::beamtree
