#include "tests/bench/beam_sets.h"

#include <algorithm>

#include "core/math/rng.h"
#include "tests/bench/tracing_scenes.h"

namespace caustics::bench {

namespace {

SceneDesc pool_under(int resolution, double waves, int lamps) {
    SceneDesc desc = pool_scene(resolution, waves);
    const auto light = std::get<PointLight>(desc.lights[0]);
    desc.lights.clear();
    for (int i = 0; i < lamps * lamps; ++i) {
        PointLight lamp = light;
        const auto n = static_cast<float>(lamps);
        lamp.position += 0.4F / n *
                         Vec3(static_cast<float>(i % lamps) - n / 2 + 0.5F,
                              static_cast<float>(i / lamps) - n / 2 + 0.5F, 0);
        desc.lights.push_back(lamp);
    }
    return desc;
}

}  // namespace

PoolBeams::PoolBeams(int resolution, double waves, int lamps)
    : scene(pool_under(resolution, waves, lamps)),
      casters(beamtree::caster_meshes(scene, 1)),
      lights(beamtree::sample_lights(scene, 1, 1)) {
    for (beamtree::BeamSet& set : beamtree::trace_all_beams(scene, casters, lights, {}))
        (set.refracted ? sets : reflected).push_back(std::move(set));
}

std::vector<beamtree::BeamNumber> numbers(const std::vector<beamtree::BeamSet>& sets,
                                          std::uint32_t set) {
    std::vector<beamtree::BeamNumber> all;
    for (std::uint32_t i = 0; i < sets[set].beams.size(); ++i) all.push_back({set, i});
    return all;
}

const char* name(Order order) { return order == Order::tiles ? "tiles" : "random"; }

std::vector<ReceiverPoint> floor_points(Order order, std::size_t count) {
    constexpr std::size_t side = 512;
    constexpr std::size_t tile = 16;
    constexpr std::size_t samples = 4;
    std::vector<ReceiverPoint> points(count);
    Rng rng(1, Stage::test, 0);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t pixel = i / samples;
        // Every few tiles of the picture, so that any number of them covers it.
        const std::size_t chosen = pixel / (tile * tile) * (side * side * samples / count);
        const std::size_t x = chosen % (side / tile) * tile + pixel % tile;
        const std::size_t y = chosen / (side / tile) * tile + pixel / tile % tile;
        Vec2 at(static_cast<float>(x) + rng.next(), static_cast<float>(y) + rng.next());
        if (order == Order::random) at = side * Vec2(rng.next(), rng.next());
        at = 1.8F * (at / side - Vec2::Constant(0.5F));
        points[i].position = Vec3(at.x(), at.y(), -1);
        points[i].geometric_normal = Vec3::UnitZ();
    }
    return points;
}

std::size_t ask(const FindBeams& find, std::span<const ReceiverPoint> points, std::size_t batch,
                Hits* all) {
    std::vector<std::vector<beamtree::BeamHit>> hits(batch);
    std::size_t sum = 0;
    for (std::size_t first = 0; first < points.size(); first += batch) {
        const std::size_t count = std::min(batch, points.size() - first);
        for (std::vector<beamtree::BeamHit>& of_point : hits) of_point.clear();
        find(points.subspan(first, count), hits);
        for (std::size_t i = 0; i < count; ++i) {
            sum += hits[i].size();
            if (all == nullptr) continue;
            for (const beamtree::BeamHit& hit : hits[i])
                all->emplace_back(first + i, hit.beam, hit.winding);
        }
    }
    if (all != nullptr) std::sort(all->begin(), all->end());
    return sum;
}

}  // namespace caustics::bench
