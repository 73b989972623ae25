#pragma once

#include "photonmap/kernels/candidate_loops.h"
#include "photonmap/kernels/left_balanced.h"

namespace caustics::photonmap {

/// The walk of a packed tree: nearest bucket first, a bucket at a time.
template <typename Lanes>
class PackedWalk {
public:
    static float find(const PackedView& tree, const NearestQuery& query, Candidates& found) {
        PackedWalk walk(tree, query, found);
        return walk.run() ? walk.nearest_bound_ : -1;
    }

private:
    /// A subtree put off: along each axis the square of a distance that no photon in it is within,
    /// and their sum.
    struct Pending {
        float square[3];
        float squared_distance;
        uint64_t node;
    };

    PackedWalk(const PackedView& tree, const NearestQuery& query, Candidates& found)
        : tree_(tree),
          query_(query),
          found_(found),
          nearest_bound_(query.max_squared_distance),
          bound_(with_margin(nearest_bound_)),
          trigger_(0) {
        found.count = 0;
        put_off_shrinking(usual_trigger());
    }

    bool run() {
        if (tree_.bucket_count == 0) return true;
        Pending at{{0, 0, 0}, 0, root_of_search()};
        uint64_t leaf = descend(at);
        for (bool more = true; more;) {
            // The next bucket is looked for before this one is scanned, so that it comes meanwhile.
            const uint64_t scanned = leaf;
            more = take_pending(at);
            if (more) leaf = descend(at);
            fetch(leaf);
            scan(tree_.buckets + scanned * bucket_bytes,
                 static_cast<uint32_t>(scanned * bucket_photons));
            if (found_.count < trigger_) continue;
            if (!shrink()) return false;
            if (!more || at.squared_distance <= bound_) continue;
            more = take_pending(at);
            if (more) leaf = descend(at);
        }
        return finish();
    }

    /// The subtree put off last, of those within the bound. False when there is none.
    bool take_pending(Pending& taken) {
        while (pending_count_ > 0) {
            taken = pending_[--pending_count_];
            if (taken.squared_distance <= bound_) return true;
        }
        return false;
    }

    void fetch(uint64_t leaf) const {
        const unsigned char* const bucket = tree_.buckets + leaf * bucket_bytes;
        for (size_t i = 0; i < 3 * sizeof(float) * bucket_photons; i += 64)
            __builtin_prefetch(bucket + i);
    }

    /// Where the point lies as seen from a plane. The plane's lowest two bits hold its axis: its place
    /// is known up to the four numbers that share the other bits.
    struct Side {
        unsigned axis;
        bool right;
        float square;  ///< of a distance that nothing on the other side is within
    };
    Side side_of(uint32_t plane) const {
        const unsigned axis = plane & 3U;
        const float one_end = float_of(plane & ~3U), other_end = float_of(plane | 3U);
        const float low = -largest(-one_end, -other_end), high = largest(one_end, other_end);
        const float x = query_.point[axis];
        // One of the two is negative; no branch, because none could be foretold.
        const float gap = largest(largest(x - high, low - x), 0);
        return {axis, x > low, gap * gap};
    }

    /// The smallest subtree that holds all that is within the bound.
    uint64_t root_of_search() const {
        uint64_t node = 1;
        while (node < tree_.bucket_count) {
            const Side side = side_of(tree_.planes[node]);
            if (side.square <= bound_) break;
            node = 2 * node + (side.right ? 1 : 0);
        }
        return node;
    }

    /// Goes down to the bucket on the point's side of every plane.
    uint64_t descend(const Pending& from) {
        Pending at = from;
        while (at.node < tree_.bucket_count) {
            const Side side = side_of(tree_.planes[at.node]);
            Pending& far = pending_[pending_count_];
            far.square[0] = at.square[0];
            far.square[1] = at.square[1];
            far.square[2] = at.square[2];
            far.square[side.axis] = side.square;
            // The same operations as for a photon: rounding keeps the order of distances.
            far.squared_distance = far.square[0] + far.square[1] + far.square[2];
            at.node = 2 * at.node + (side.right ? 1 : 0);
            far.node = at.node ^ 1U;
            pending_count_ += far.squared_distance <= bound_ ? 1 : 0;
        }
        return leaf_number(at.node, tree_.bucket_count);
    }

    void scan(const unsigned char* bucket, uint32_t first_index) {
        const auto* const x = reinterpret_cast<const float*>(bucket);
        const float* const y = x + bucket_photons;
        const float* const z = y + bucket_photons;
        const auto limit = Lanes::all(bound_);
        const auto px = Lanes::all(query_.point[0]);
        const auto py = Lanes::all(query_.point[1]);
        const auto pz = Lanes::all(query_.point[2]);
        const size_t before = found_.count;
        size_t count = before;
        float* const squared_distance = found_.squared_distance;
        uint32_t* const index = found_.index;
        for (size_t i = 0; i < bucket_photons; i += Lanes::width) {
            const auto dx = Lanes::sub(Lanes::load(x + i), px);
            const auto dy = Lanes::sub(Lanes::load(y + i), py);
            const auto dz = Lanes::sub(Lanes::load(z + i), pz);
            const auto d2 =
                Lanes::add(Lanes::add(Lanes::mul(dx, dx), Lanes::mul(dy, dy)), Lanes::mul(dz, dz));
            const uint32_t mask = Lanes::not_above(d2, limit);
            Lanes::compress(squared_distance + count, mask, d2);
            Lanes::compress(index + count, mask,
                            Lanes::counting_from(first_index + static_cast<uint32_t>(i)));
            count += Lanes::count(mask);
        }
        found_.count = count;
        if (query_.side != nullptr && count > before) drop_back_side(bucket, first_index, before);
    }

    void drop_back_side(const unsigned char* bucket, uint32_t first_index, size_t before) {
        const unsigned char* const direction = bucket + 16 * bucket_photons;
        const unsigned char* const facing = bucket + 18 * bucket_photons;
        size_t kept = before;
        for (size_t i = before; i < found_.count; ++i) {
            const size_t at = 2 * (found_.index[i] - first_index);
            uint16_t flags;
            memcpy(&flags, facing + at, sizeof flags);
            found_.squared_distance[kept] = found_.squared_distance[i];
            found_.index[kept] = found_.index[i];
            kept += counts_at(*query_.side, direction[at], direction[at + 1], flags) ? 1 : 0;
        }
        found_.count = kept;
    }

    /// Makes room and the search smaller. False when what must be kept does not fit.
    bool shrink() {
        const size_t nearest = query_.nearest;
        if (query_.margin > 0) {
            const auto kth =
                Selection<Lanes>::bound_for(found_.squared_distance, found_.count, found_.count,
                                            nearest, nearest + nearest / 8, 0, bound_);
            if (kth.value < nearest_bound_) nearest_bound_ = kth.value;
            bound_ = with_margin(nearest_bound_);
            CandidateLoops<Lanes>::keep_not_above(found_, bound_);
            put_off_shrinking(found_.count + found_.count / 2 + 2 * bucket_photons);
            return found_.count < trigger_;
        }
        bound_ = CandidateLoops<Lanes>::shrink(found_, nearest, nearest + nearest / 8, bound_);
        if (found_.count > nearest + nearest / 8)
            query_.drop_ties(query_.tie_context, found_, nearest);
        put_off_shrinking(usual_trigger());
        return true;
    }

    bool finish() {
        if (found_.count <= query_.nearest) return true;
        if (query_.margin > 0) {
            shrink();
            return true;
        }
        CandidateLoops<Lanes>::shrink(found_, query_.nearest, query_.nearest, bound_);
        if (found_.count > query_.nearest)
            query_.drop_ties(query_.tie_context, found_, query_.nearest);
        return true;
    }

    /// With fewer candidates a better bound spares less than finding it costs.
    size_t usual_trigger() const { return query_.nearest + query_.nearest / 2 + bucket_photons; }

    /// A whole bucket must fit behind the candidates that do not trigger.
    void put_off_shrinking(size_t trigger) {
        const size_t most = found_.capacity - bucket_photons;
        trigger_ = trigger < most ? trigger : most;
    }

    /// Enlarged by more than rounding can take off.
    float with_margin(float squared_distance) const {
        if (!(query_.margin > 0)) return squared_distance;
        return reached(__builtin_sqrtf(squared_distance) + query_.margin);
    }

    static float largest(float a, float b) { return a > b ? a : b; }

    static float float_of(uint32_t bits) {
        float value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }

    const PackedView& tree_;
    const NearestQuery& query_;
    Candidates& found_;
    float nearest_bound_;  ///< of the squared distance of the N nearest
    float bound_;          ///< of the squared distance of what is collected
    size_t trigger_;       ///< so many candidates are worth shrinking
    Pending pending_[64];
    size_t pending_count_ = 0;
};

}  // namespace caustics::photonmap
