#include "photonmap/tree/photon_widths.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "core/base/parallel.h"
#include "photonmap/tree/resolvable_radius.h"

namespace caustics::photonmap {
namespace {

constexpr std::size_t buckets_together = 32;
/// Squares of smaller radii are no normal floats.
constexpr float smallest_radius = 1e-18F;

/// Where a photon landed, seen from the side it came from. Where the surface is not known the photon's direction
/// stands for its normal.
ReceiverPoint landing_of(const Photon& photon) {
    ReceiverPoint point;
    point.position = position(photon);
    point.geometric_normal = incoming(photon);
    if ((photon.flags & facing_mask) == 0) return point;
    const Facing at = facing_of(photon.flags);
    point.geometric_normal =
        Vec3(static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z))
            .normalized();
    return point;
}

}  // namespace

AlignedArray<float> photon_widths(const PackedKdTree& tree, const DiscWidths& widths,
                                  const RunOptions& options) {
    const std::size_t buckets = (tree.size() + bucket_photons - 1) / bucket_photons;
    AlignedArray<float> radii;
    radii.reserve(buckets * bucket_photons);
    float* const radius = radii.data();
    std::fill_n(radius, buckets * bucket_photons, 0.0F);
    const auto narrowing = static_cast<float>(std::sqrt(widths.share));
    // A photon is the nearest to itself.
    const GatherLimits limits{widths.nearest + 1, widths.max_radius, false, 0};
    std::atomic<std::size_t> done{0};
    parallel_chunks(options.threads, buckets, buckets_together, [&](const Chunk& chunk) {
        GatherScratch scratch;
        std::vector<ReceiverPoint> landings;
        for (std::size_t bucket = chunk.first; bucket < chunk.end; ++bucket) {
            const std::size_t first = bucket * bucket_photons;
            const std::size_t count = std::min(bucket_photons, tree.size() - first);
            landings.clear();
            for (std::size_t i = 0; i < count; ++i)
                landings.push_back(landing_of(tree.photon(first + i)));
            const auto take = [&](std::size_t i, float width) {
                const float least = std::max(
                    resolvable_radius(landings[i].position, widths.max_radius), smallest_radius);
                radius[first + i] = std::max(narrowing * width, least);
            };
            if (widths.fixed)
                for (std::size_t i = 0; i < count; ++i) take(i, widths.max_radius);
            else
                tree.gather(landings, limits, scratch,
                            [&](std::size_t i, const GatheredPhotons& near) {
                                take(i, near.full ? std::sqrt(near.squared_distance[near.farthest])
                                                  : widths.max_radius);
                            });
        }
        done += chunk.end - chunk.first;
        options.report(static_cast<double>(done) / static_cast<double>(buckets));
    });
    return radii;
}

}  // namespace caustics::photonmap
