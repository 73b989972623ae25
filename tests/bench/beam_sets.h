#pragma once

#include <functional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "beamtree/light/beam_point.h"
#include "beamtree/tracing/beam_tracing.h"

namespace caustics::bench {

/// The pool of tracing_scenes.h, its waves this many times as high (2.5 folds the caustic), under
/// `lamps` x `lamps` points within 0.4 m in place of its light.
struct PoolBeams {
    Scene scene;
    std::vector<beamtree::CasterMesh> casters;
    std::vector<beamtree::LightSample> lights;
    std::vector<beamtree::BeamSet> sets;       ///< refracted: what shines on the floor; one a light
    std::vector<beamtree::BeamSet> reflected;  ///< what goes up again

    PoolBeams(int resolution, double waves, int lamps = 1);
};

/// All beams of one of the sets.
std::vector<beamtree::BeamNumber> numbers(const std::vector<beamtree::BeamSet>& sets,
                                          std::uint32_t set = 0);

/// Points of the floor that the caustic covers.
enum class Order {
    tiles,  ///< of a picture of 512 x 512 pixels: 16 x 16 each, four samples a pixel
    random
};
const char* name(Order order);
std::vector<ReceiverPoint> floor_points(Order order, std::size_t count);

/// Appends the hits at each point to the list of the same place.
using FindBeams =
    std::function<void(std::span<const ReceiverPoint>, std::span<std::vector<beamtree::BeamHit>>)>;

/// A hit: the query, the beam, its winding.
using Hits = std::vector<std::tuple<std::size_t, std::uint32_t, int>>;

/// Asks about all points, `batch` of them at a time, and returns the number of hits; they are
/// appended to `all`, sorted, if it is given.
std::size_t ask(const FindBeams& find, std::span<const ReceiverPoint> points, std::size_t batch,
                Hits* all = nullptr);

}  // namespace caustics::bench
