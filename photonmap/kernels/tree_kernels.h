#pragma once

#include <stddef.h>
#include <stdint.h>

#include "photonmap/kernels/n_choice.h"
#include "photonmap/photons/direction_tables.h"
#include "photonmap/photons/facing_code.h"

namespace caustics::photonmap {

/// What the loops that are written for several instruction sets share: plain data, so that a
/// source compiled for wide registers includes no inline code of Eigen or the standard library.

/// Floats in a register of the widest kind.
constexpr size_t widest_register = 16;

/// Photons that may belong to a query's answer. Arrays have room for `capacity` entries and a
/// register of the widest kind behind them.
struct Candidates {
    float* squared_distance = nullptr;  ///< [m^2]
    uint32_t* index = nullptr;          ///< of the photon, as its tree numbers them
    size_t count = 0;
    size_t capacity = 0;
};

/// Which photons count: those whose direction of arrival lies on the normal's side, and which landed
/// on a surface that may be the normal's.
struct SideTest {
    const DirectionTables* tables;
    float normal[3];
};

/// The test's arithmetic, each operation rounded to float in the order in which Eigen's dot product
/// does it; the same on every instruction set.
static inline bool on_front_side(const SideTest& side, unsigned theta, unsigned phi) {
    const SineCosine t = side.tables->theta[theta];
    const SineCosine p = side.tables->phi[phi];
    const float rest = t.sine * p.sine * side.normal[1] + t.cosine * side.normal[2];
    return t.sine * p.cosine * side.normal[0] + rest > 0;
}

static inline bool counts_at(const SideTest& side, unsigned theta, unsigned phi, unsigned flags) {
    return on_front_side(side, theta, phi) && is_same_surface(flags, side.normal);
}

/// A distance squared, enlarged by more than rounding can take off.
static inline float reached(float distance) { return distance * distance * 1.000004F + 1e-37F; }

/// Leaves, of candidates at equal largest distance, as many as make `nearest` in all.
using DropTies = void (*)(const void* context, Candidates& found, size_t nearest);

/// One query for the N nearest photons.
struct NearestQuery {
    float point[3];
    size_t nearest;              ///< N >= 1
    float max_squared_distance;  ///< of the N nearest; finite [m^2]
    /// Collect photons up to this much beyond the N-th distance as well; then more than N [m].
    float margin;
    const SideTest* side;  ///< or nullptr: all photons count
    DropTies drop_ties;
    const void* tie_context;
};

/// A packed tree's memory (packed_kd_tree.h).
struct PackedView {
    const unsigned char* buckets;
    const uint32_t* planes;  ///< of nodes 1 .. bucket_count - 1
    uint64_t bucket_count;
};

constexpr size_t bucket_photons = 64;
constexpr size_t bucket_bytes = 20 * bucket_photons;
/// Ranges of at most so many photons are ordered in registers and fixed scratch.
constexpr size_t small_range = 4096;

/// Two sets of columns and the photons' other halves, in which a small range is ordered.
struct OrderScratch {
    static constexpr size_t room = small_range + widest_register;
    struct Columns {
        float position[3][room];
        uint32_t source[room];
    };
    Columns columns[2];
    uint64_t payload[small_range];
};

/// A range of photons to be cut into buckets.
struct BucketRange {
    unsigned char* photons;  ///< an array of 20-byte photons, a bucket's place
    size_t count;
    uint64_t node;    ///< of the range in the tree of buckets
    uint64_t leaves;  ///< buckets in the range
    uint32_t* planes;
};

/// Found photons, copied out. Room as in Candidates.
struct CopiedPhotons {
    uint32_t* energy;
    uint16_t* direction;
    float* position[3];  ///< null where positions are not wanted
    uint16_t* flags;     ///< null where they are not wanted; find_in_columns copies none
};

struct Farthest {
    size_t place;
    bool alone;  ///< no other candidate is as far
};

/// A packed tree whose photons have a disc each (photon_discs.h).
struct DiscView {
    PackedView tree;
    const float*
        radius;  ///< of each photon's disc [m], bucket by bucket; 0 where there is no photon
};

/// One query for the discs that hold a point, or that may reach a cell round it.
struct DiscQuery {
    float point[3];
    /// A disc of radius r reaches the query up to the distance widening * r + margin [m].
    float widening;
    float margin;
};

/// Photons whose discs reach a query, side by side. Room as in Candidates.
struct CoveringPhotons {
    float* squared_distance;  ///< [m^2]
    float* radius;            ///< of the discs [m]
    CopiedPhotons copies;     ///< with positions
};

/// The loops, for one instruction set. Every set gives the same bits.
struct TreeKernels {
    /// Finds the nearest in a packed tree and returns a squared distance within which they lie. With a
    /// margin it gives up, and returns a negative number, when the photons do not fit.
    float (*find_packed)(const PackedView&, const NearestQuery&, Candidates&);
    /// Finds the nearest of `count` photons that are copied out, and copies them. False when equal
    /// distances leave a choice; then `found` holds, as places among these photons, more than wanted.
    bool (*find_in_columns)(const CopiedPhotons&, size_t count, const NearestQuery&,
                            Candidates& found, const CopiedPhotons& to);
    /// The N-th smallest squared distance of photons that are copied out, -1 where fewer than N are within the
    /// query's; `squared_distance` has room for all.
    float (*nth_in_columns)(const CopiedPhotons&, size_t count, const NearestQuery&,
                            float* squared_distance);
    /// Copies the photons of these buckets whose discs reach the query; returns their number.
    size_t (*find_covering)(const DiscView&, const DiscQuery&, const uint32_t* buckets,
                            size_t bucket_count, const CoveringPhotons& to);
    /// Drops candidates until `most` or (ties aside) fewer, but at least `nearest` are left, and
    /// returns the largest squared distance that a further one may have.
    float (*shrink)(Candidates&, size_t nearest, size_t most, float bound);
    /// The first of the farthest candidates; there must be one.
    Farthest (*farthest)(const Candidates&);
    /// Chooses how many of a point's photons to take.
    NChooser* choose_count;
    /// Bounds of the positions of an array of 20-byte photons.
    void (*bounds)(const unsigned char* photons, size_t count, float least[3], float greatest[3]);
    /// Orders at most small_range photons as an in-order walk of their left-balanced tree.
    void (*order_small)(unsigned char* photons, size_t count, OrderScratch&);
    /// Cuts at most small_range photons into buckets and writes these in their place.
    void (*fill_buckets)(const BucketRange&, OrderScratch&);
};

const TreeKernels& plain_tree_kernels();
const TreeKernels& avx2_tree_kernels();
const TreeKernels& avx512_tree_kernels();

}  // namespace caustics::photonmap
