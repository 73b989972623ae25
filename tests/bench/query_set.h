#pragma once

#include <string>
#include <vector>

#include "photonmap/tree/photon_tree.h"
#include "tests/bench/caustic_sets.h"
#include "tests/bench/nanoflann_peer.h"

namespace caustics::bench {

/// Which points of the floor are asked about, in the order of a picture's pixels.
enum class Density {
    sparse,  ///< bands of rows of 320 x 240 points
    dense,  ///< bands of rows of 1280 x 960 points: the paper's 640 x 480 with four samples a pixel
    tiles   ///< the same as `dense`, tile by tile of 4 x 4 points
};
const char* name(Density density);

struct QuerySet {
    std::vector<ReceiverPoint> points;
    std::size_t batch = 0;  ///< consecutive points that are asked about together: a row or a tile
};
QuerySet make_queries(Caustic caustic, Density density, bool quick);

/// How many photons a query found, and the largest squared distance of them.
struct Answer {
    std::size_t count = 0;
    float squared_distance = 0;

    bool operator==(const Answer&) const = default;
};
using Answers = std::vector<Answer>;

void ask(const photonmap::PhotonTree& tree, const QuerySet& queries,
         const photonmap::GatherLimits& limits, photonmap::GatherScratch& scratch,
         Answers& answers);
void ask(const NanoflannTree& tree, NanoflannTree::ResultSet set, const QuerySet& queries,
         const photonmap::GatherLimits& limits, Answers& answers);

/// Throws std::runtime_error naming the contestant and the first query whose answers differ.
void require_same(const Answers& answers, const Answers& truth, const std::string& contestant);

photonmap::GatherLimits limits_of(Caustic caustic, std::size_t k, std::size_t photons);

/// The photons of a caustic, traced when first asked for and kept.
const std::vector<photonmap::Photon>& photons_of(Caustic caustic, Arrival arrival,
                                                 std::size_t count);
photonmap::PhotonStore store_of(const std::vector<photonmap::Photon>& photons);

}  // namespace caustics::bench
