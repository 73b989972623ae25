#include "tests/bench/query_set.h"

#include <map>
#include <stdexcept>
#include <tuple>

namespace caustics::bench {

namespace {

constexpr int tile_side = 4;

ReceiverPoint receiver_at(const float* x) {
    ReceiverPoint point{};
    point.position = Vec3(x[0], x[1], x[2]);
    point.geometric_normal = point.shading_normal = point.wo = Vec3::UnitZ();
    return point;
}

/// The rows' points, tile by tile.
void append_tiles(const Queries& rows, QuerySet& queries) {
    const auto width = static_cast<std::size_t>(rows.width);
    const std::size_t height = rows.size() / width;
    for (std::size_t top = 0; top < height; top += tile_side)
        for (std::size_t left = 0; left < width; left += tile_side)
            for (std::size_t i = 0; i < tile_side * tile_side; ++i)
                queries.points.push_back(
                    receiver_at(rows[(top + i / tile_side) * width + left + i % tile_side]));
}

}  // namespace

const char* name(Density density) {
    switch (density) {
        case Density::dense: return "dense";
        case Density::tiles: return "tiles";
        case Density::sparse: break;
    }
    return "sparse";
}

QuerySet make_queries(Caustic caustic, Density density, bool quick) {
    const bool sparse = density == Density::sparse;
    const int width = sparse ? 320 : 1280, height = sparse ? 240 : 960;
    const int bands = quick ? 2 : 4, band_rows = sparse ? 16 : 4;
    const Queries rows = scanlines(caustic, width, height, bands, band_rows);
    QuerySet queries;
    if (density == Density::tiles) {
        queries.batch = tile_side * tile_side;
        append_tiles(rows, queries);
        return queries;
    }
    queries.batch = static_cast<std::size_t>(width);
    for (std::size_t i = 0; i < rows.size(); ++i) queries.points.push_back(receiver_at(rows[i]));
    return queries;
}

void ask(const photonmap::PhotonTree& tree, const QuerySet& queries,
         const photonmap::GatherLimits& limits, photonmap::GatherScratch& scratch,
         Answers& answers) {
    answers.resize(queries.points.size());
    for (std::size_t first = 0; first < queries.points.size(); first += queries.batch) {
        const std::span<const ReceiverPoint> batch(&queries.points[first], queries.batch);
        tree.gather(batch, limits, scratch,
                    [&answers, first](std::size_t i, const photonmap::GatheredPhotons& gathered) {
                        answers[first + i] = {
                            gathered.count,
                            gathered.count > 0 ? gathered.squared_distance[gathered.farthest] : 0};
                    });
    }
}

void ask(const NanoflannTree& tree, NanoflannTree::ResultSet set, const QuerySet& queries,
         const photonmap::GatherLimits& limits, Answers& answers) {
    answers.resize(queries.points.size());
    std::vector<std::uint32_t> indices(limits.nearest);
    std::vector<float> distances(limits.nearest);
    for (std::size_t i = 0; i < queries.points.size(); ++i) {
        const std::size_t count =
            tree.nearest(set, queries.points[i].position.data(), limits.nearest,
                         limits.max_radius * limits.max_radius, indices.data(), distances.data());
        // The last of a sorted array, the root of a max-heap.
        const std::size_t farthest = set == NanoflannTree::ResultSet::stock ? count - 1 : 0;
        answers[i] = {count, count > 0 ? distances[farthest] : 0};
    }
}

void require_same(const Answers& answers, const Answers& truth, const std::string& contestant) {
    if (answers.size() != truth.size())
        throw std::runtime_error(contestant + " did not answer every query");
    for (std::size_t i = 0; i < truth.size(); ++i)
        if (!(answers[i] == truth[i]))
            throw std::runtime_error(contestant + ", query " + std::to_string(i) + ": found " +
                                     std::to_string(answers[i].count) +
                                     " photons within squared distance " +
                                     std::to_string(answers[i].squared_distance) + ", right are " +
                                     std::to_string(truth[i].count) + " within " +
                                     std::to_string(truth[i].squared_distance));
}

photonmap::GatherLimits limits_of(Caustic caustic, std::size_t k, std::size_t photons) {
    return {k, max_radius(caustic, k, photons)};
}

const std::vector<photonmap::Photon>& photons_of(Caustic caustic, Arrival arrival,
                                                 std::size_t count) {
    static std::map<std::tuple<Caustic, Arrival, std::size_t>, std::vector<photonmap::Photon>> sets;
    std::vector<photonmap::Photon>& photons = sets[{caustic, arrival, count}];
    if (photons.empty()) photons = caustic_photons(caustic, arrival, count);
    return photons;
}

photonmap::PhotonStore store_of(const std::vector<photonmap::Photon>& photons) {
    photonmap::PhotonStore store(photons.size());
    store.append(photons);
    return store;
}

}  // namespace caustics::bench
