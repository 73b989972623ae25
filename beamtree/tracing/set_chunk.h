#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "beamtree/beams/ray_origin.h"
#include "beamtree/tracing/ray_arrival.h"

namespace caustics::beamtree {

/// Which ray of a chunk belongs to a key: open addressing in a power of two places.
class RayIndex {
public:
    /// The ray of the key, or Beam::none.
    std::uint32_t find(std::uint32_t key) const;
    /// A key that is not there yet.
    void add(std::uint32_t key, std::uint32_t ray);

private:
    struct Place {
        std::uint32_t key;
        std::uint32_t ray = Beam::none;  ///< none: free
    };
    static std::size_t hash(std::uint32_t key) { return key * 2654435761U; }
    void grow();

    std::vector<Place> places_;
    std::size_t count_ = 0;
};

/// The beams that some polygons send on, with rays numbered for themselves: what one thread makes of a set.
struct SetChunk {
    TracedSet traced;
    std::vector<Departure> departures;  ///< one a ray, or none
    /// One a ray: what the same ray is known by in other chunks (a vertex, a ray of the parent's), or Beam::none.
    std::vector<std::uint32_t> keys;
    RayIndex rays;  ///< by their keys
};

/// Appends the chunks' beams and rays to a set in the order of the chunks; rays of one key become one, numbered where
/// it comes first, as if one thread had made them all. Keys are below `key_count`. The chunks' rays are moved.
void join(std::span<SetChunk* const> chunks, std::size_t key_count, int threads, TracedSet& traced,
          std::vector<Departure>& departures);

}  // namespace caustics::beamtree
