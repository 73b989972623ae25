// Which beams hold a point: the tree of slices against a scan over all beams, Embree's point
// queries and the paper's tree of cones; and building it, beams and all, against Embree's build of
// the same mesh. Counters are nanoseconds per query (or per triangle of the mesh). Every contestant
// ends with the same exact beam-point test, and finds the same hits before anything is timed.
//
// query/WAVES/BEAMS/ORDER     two_slice (point by point), two_slice_tile, scan, slice_scan, embree,
//                             hybrid; and the counts of tests
// cost/WAVES/ORDER            two_slice_7k, two_slice_131k
// build/BEAMS                 beams (refracted and reflected), tree, tree_reflected, embree
// area/WAVES                  apart (16 trees), together (one)

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include "beamtree/beams/quadtree.h"
#include "beamtree/cones/cone_tree.h"
#include "beamtree/light/find_in_beam.h"
#include "beamtree/slices/slice_tree.h"
#include "core/base/parallel.h"
#include "tests/bench/beam_scan_peer.h"
#include "tests/bench/beam_sets.h"
#include "tests/bench/bench.h"
#include "tests/bench/contest.h"
#include "tests/bench/embree_beams.h"

namespace caustics::bench {

namespace {

constexpr int few = 61;    // 7,442 beams
constexpr int many = 256;  // 131,072

struct Waves {
    const char* name;
    double height;
};
constexpr Waves calm{"calm", 1};
constexpr Waves folded{"folded", 2.5};

beamtree::SlicedBeams sliced(const PoolBeams& pool) {
    return {pool.sets, numbers(pool.sets), Vec3::UnitZ(), pool.scene.bounds()};
}

/// What the peers that know nothing of beams need of them.
struct Peers {
    std::unique_ptr<BeamScan> scan;
    std::unique_ptr<SliceScan> slice_scan;
    std::unique_ptr<EmbreeBeams> embree;
    float slack = 0;  ///< as the leaves' own, for the widest triangle

    Peers(const beamtree::BeamSet& set, const beamtree::SliceFrame& frame) {
        std::vector<SlicedPeer> triangles;
        std::vector<RaysPeer> rays;
        float largest = 0;
        float widest = 0;
        for (const beamtree::Beam& beam : set.beams) {
            SlicedPeer sliced;
            RaysPeer bare;
            const auto corners = set.triangle(beam, 0);
            for (std::size_t c = 0; c < 3; ++c) {
                std::copy_n(corners[c]->position.data(), 3, bare.position[c]);
                std::copy_n(corners[c]->direction.data(), 3, bare.direction[c]);
                const beamtree::RaySlices at = frame.slices(*corners[c]);
                for (std::size_t axis = 0; axis < 2; ++axis) {
                    sliced.corner[c][axis] = at[axis];
                    sliced.growth[c][axis] = at[2 + axis] - at[axis];
                    const float apart = at[axis] - sliced.corner[0][axis];
                    const float grown = sliced.growth[c][axis] - sliced.growth[0][axis];
                    largest = std::max({largest, std::abs(at[axis]), std::abs(at[2 + axis])});
                    widest = std::max({widest, std::abs(apart), std::abs(apart + grown)});
                }
            }
            triangles.push_back(sliced);
            rays.push_back(bare);
        }
        slack = 5e-6F * largest * 2 * widest;
        scan = std::make_unique<BeamScan>(rays);
        slice_scan = std::make_unique<SliceScan>(triangles);
        embree = std::make_unique<EmbreeBeams>(triangles);
    }
};

/// A pool's beams and what finds them.
struct Finders {
    PoolBeams pool;
    beamtree::SliceTree slices;
    Peers peers;
    beamtree::ConeTree cones;
    beamtree::SearchCounts slice_counts;
    beamtree::SearchCounts cone_counts;
    std::vector<std::uint32_t> stack;
    std::vector<std::uint32_t> found;

    Finders(int resolution, double waves, Isa isa)
        : pool(resolution, waves),
          slices(sliced(pool), isa),
          peers(pool.sets[0], slices.frame()),
          cones(pool.sets[0], 0,
                beamtree::quadtree(pool.sets[0], in_order(pool), pool.casters[0].mesh.patches), {},
                {}),
          found(pool.sets[0].beams.size()) {}

    /// What they return does not outlive them.
    FindBeams two_slice() {
        return [this](auto points, auto hits) {
            slices.find(pool.sets, points, stack, hits, slice_counts);
        };
    }
    FindBeams hybrid() {
        return [this](auto points, auto hits) {
            for (std::size_t i = 0; i < points.size(); ++i)
                cones.find(pool.sets[0], points[i].position, points[i].geometric_normal, stack,
                           hits[i], cone_counts);
        };
    }
    FindBeams scan() {
        return [this](auto points, auto hits) {
            const Vec3& normal = slices.frame().normal();
            for (std::size_t i = 0; i < points.size(); ++i)
                test(peers.scan->find(points[i].position.data(), normal.data(), peers.slack,
                                      found.data()),
                     points[i], hits[i]);
        };
    }
    /// Of those that are asked by coordinates of the slab.
    template <typename Peer>
    FindBeams sliced_peer(const Peer& peer) {
        return [this, &peer](auto points, auto hits) {
            const beamtree::SliceFrame& frame = slices.frame();
            for (std::size_t i = 0; i < points.size(); ++i) {
                const Vec3& point = points[i].position;
                const Vec2d at = frame.across(point.cast<double>());
                test(peer.find(static_cast<float>(at.x()), static_cast<float>(at.y()),
                               static_cast<float>(frame.share(frame.height(point))), peers.slack,
                               found.data()),
                     points[i], hits[i]);
            }
        };
    }

private:
    static std::vector<std::uint32_t> in_order(const PoolBeams& pool) {
        std::vector<std::uint32_t> beams;
        for (const beamtree::BeamNumber& number : numbers(pool.sets)) beams.push_back(number.beam);
        return beams;
    }
    // The exact tests of those that were found.
    void test(std::size_t count, const ReceiverPoint& point,
              std::vector<beamtree::BeamHit>& hits) const {
        const beamtree::TestPlane plane(point.position, slices.frame().normal());
        beamtree::SearchCounts counts;
        for (std::size_t i = 0; i < count; ++i)
            beamtree::find_in_beam(pool.sets[0], {0, found[i]}, plane, hits, counts);
    }
};

/// The finders of the pool asked for last are kept, for the next benchmark of the same pool.
std::shared_ptr<Finders> finders_of(int resolution, const Waves& waves, Isa isa) {
    static std::shared_ptr<Finders> last;
    static std::pair<int, double> last_pool;
    if (last && last_pool == std::pair(resolution, waves.height)) return last;
    last.reset();
    last = std::make_shared<Finders>(resolution, waves.height, isa);
    last_pool = {resolution, waves.height};
    return last;
}

void note_counts(Contest& contest, const std::string& name, const beamtree::SearchCounts& counts,
                 double queries) {
    contest.note(name + "_cone_tests", static_cast<double>(counts.cone_point_tests) / queries);
    contest.note(name + "_beam_tests", static_cast<double>(counts.beam_point_tests) / queries);
    contest.note(name + "_hits", static_cast<double>(counts.beam_point_hits) / queries);
}

using Points = std::vector<ReceiverPoint>;

/// Points of a picture's tile are asked about together, as the eye pass does.
constexpr std::size_t tile = 64;

/// A contestant that answers these points, whose hits must be the truth.
void add(Contest& contest, const std::string& name, const FindBeams& find, const Points& points,
         std::size_t batch, const Hits& truth) {
    Hits expected = truth;
    std::erase_if(expected, [&](const auto& hit) { return std::get<0>(hit) >= points.size(); });
    Hits hits;
    ask(find, points, batch, &hits);
    if (hits != expected)
        throw std::runtime_error(name + " does not find the hits of the paper's tree");
    contest.add(
        name, [=] { benchmark::DoNotOptimize(ask(find, points, batch)); }, {},
        static_cast<double>(points.size()));
}

Contest query_contest(int resolution, const Waves& waves, Order order,
                      const BenchOptions& options) {
    const auto finders = finders_of(resolution, waves, options.isa);
    const Points points = floor_points(order, options.quick ? 4096 : 32768);
    const Points fewer(points.begin(), points.begin() + (resolution == many ? 256 : 2048));
    const auto count = static_cast<double>(points.size());
    Contest contest(count);
    Hits truth;
    finders->slice_counts = finders->cone_counts = {};
    ask(finders->hybrid(), points, 1, &truth);
    note_counts(contest, "hybrid", finders->cone_counts, count);
    add(contest, "two_slice", finders->two_slice(), points, 1, truth);
    note_counts(contest, "two_slice", finders->slice_counts, count);
    add(contest, "two_slice_tile", finders->two_slice(), points, tile, truth);
    add(contest, "embree", finders->sliced_peer(*finders->peers.embree), points, 1, truth);
    add(contest, "hybrid", finders->hybrid(), points, 1, truth);
    add(contest, "scan", finders->scan(), fewer, 1, truth);
    add(contest, "slice_scan", finders->sliced_peer(*finders->peers.slice_scan), fewer, 1, truth);
    return contest;
}

Contest cost_contest(const Waves& waves, Order order, const BenchOptions& options) {
    const auto points = std::make_shared<const Points>(floor_points(order, 32768));
    Contest contest(static_cast<double>(points->size()));
    for (const int resolution : {few, many}) {
        const auto pool = std::make_shared<const PoolBeams>(resolution, waves.height);
        const auto tree = std::make_shared<const beamtree::SliceTree>(sliced(*pool), options.isa);
        const FindBeams find = [=](auto some, auto hits) {
            std::vector<std::uint32_t> stack;
            beamtree::SearchCounts counts;
            tree->find(pool->sets, some, stack, hits, counts);
        };
        contest.add(resolution == few ? "two_slice_7k" : "two_slice_131k",
                    [=] { benchmark::DoNotOptimize(ask(find, *points, tile)); });
    }
    return contest;
}

/// Sixteen points of a lamp: all of their beams in one tree, or a tree for each.
Contest area_contest(const BenchOptions& options) {
    const auto points = std::make_shared<const Points>(floor_points(Order::tiles, 4096));
    const auto pool = std::make_shared<const PoolBeams>(few, calm.height, 4);
    const auto trees = std::make_shared<std::vector<beamtree::SliceTree>>();
    beamtree::SlicedBeams all = sliced(*pool);
    all.beams.clear();
    for (std::uint32_t i = 0; i < pool->sets.size(); ++i) {
        beamtree::SlicedBeams one = sliced(*pool);
        one.beams = numbers(pool->sets, i);
        all.beams.insert(all.beams.end(), one.beams.begin(), one.beams.end());
        trees->emplace_back(std::move(one), options.isa);
    }
    trees->emplace_back(std::move(all), options.isa);
    const std::span<const beamtree::SliceTree> every(*trees);
    // It holds on to the trees.
    const auto find_in = [=](std::span<const beamtree::SliceTree> chosen) -> FindBeams {
        return [pool, trees, chosen](auto some, auto hits) {
            std::vector<std::uint32_t> stack;
            beamtree::SearchCounts counts;
            for (const beamtree::SliceTree& tree : chosen)
                tree.find(pool->sets, some, stack, hits, counts);
        };
    };
    Contest contest(static_cast<double>(points->size()));
    Hits truth;
    ask(find_in(every.first(pool->sets.size())), *points, tile, &truth);
    add(contest, "apart", find_in(every.first(pool->sets.size())), *points, tile, truth);
    add(contest, "together", find_in(every.last(1)), *points, tile, truth);
    return contest;
}

Contest build_contest(int resolution, const BenchOptions& options) {
    const auto pool = std::make_shared<const PoolBeams>(resolution, calm.height);
    const TriangleMesh& mesh = pool->casters[0].mesh;
    Contest contest(static_cast<double>(mesh.triangles.size()));
    contest.add("beams", [pool] {
        benchmark::DoNotOptimize(
            beamtree::trace_all_beams(pool->scene, pool->casters, pool->lights, {}).size());
    });
    contest.add("tree", [pool, isa = options.isa] {
        benchmark::DoNotOptimize(beamtree::SliceTree(sliced(*pool), isa).node_count());
    });
    contest.add("tree_reflected", [pool, isa = options.isa] {
        const beamtree::SlicedBeams up{pool->reflected, numbers(pool->reflected), -Vec3::UnitZ(),
                                       pool->scene.bounds()};
        benchmark::DoNotOptimize(beamtree::SliceTree(up, isa).node_count());
    });
    const auto embree = std::make_shared<std::unique_ptr<EmbreeMesh>>();
    contest.add(
        "embree", [embree] { run_single_threaded([&] { (*embree)->commit(); }); },
        [pool, embree, &mesh] {
            *embree =
                std::make_unique<EmbreeMesh>(mesh.positions.front().data(), mesh.positions.size(),
                                             mesh.triangles.front().data(), mesh.triangles.size());
        });
    return contest;
}

}  // namespace

void register_benchmarks(const BenchOptions& options) {
    for (const Waves& waves : {calm, folded}) {
        for (const int resolution : {few, many}) {
            if (options.quick && resolution == many) continue;
            for (const Order order : {Order::tiles, Order::random})
                register_contest(
                    "query/" + std::string(waves.name) + "/" +
                        std::to_string(2 * resolution * resolution) + "/" + name(order),
                    1, [=] { return query_contest(resolution, waves, order, options); });
        }
        if (options.quick) continue;
        for (const Order order : {Order::tiles, Order::random})
            register_contest("cost/" + std::string(waves.name) + "/" + name(order), 2,
                             [=] { return cost_contest(waves, order, options); });
    }
    if (!options.quick) register_contest("area/calm", 2, [=] { return area_contest(options); });
    const int built = options.quick ? few : many;
    register_contest("build/" + std::to_string(2 * built * built), 1,
                     [=] { return build_contest(built, options); });
}

}  // namespace caustics::bench
