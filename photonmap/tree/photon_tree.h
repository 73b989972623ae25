#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>

#include "core/caustic_estimator.h"
#include "photonmap/photons/photon_store.h"
#include "photonmap/tree/gather_scratch.h"
#include "photonmap/tree/gathered_photons.h"

namespace caustics::photonmap {

/// Which photons belong to an answer: the N nearest of those within the maximum radius; with a margin also those
/// not farther than the margin beyond the N-th, or beyond the maximum radius where there are fewer than N.
struct GatherLimits {
    /// As N: all photons within the maximum radius.
    static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();

    std::size_t nearest = 50;  ///< N >= 1
    float max_radius = 1;      ///< [m], > 0; its square must be finite
    bool positions = false;    ///< whether the answers need the photons' positions
    float margin = 0;          ///< [m]
};

/// The photons of a map, ordered. Every tree gives the same answers on every instruction set: of
/// the photons that did not come from behind the point's geometric normal, and did not land on a
/// surface that faces elsewhere (is_same_surface), the N nearest
/// (distances in float, rounded step by step, equal distances included up to the limit). Of photons
/// at the N-th distance those with the smaller (energy, direction) codes are taken, so that which
/// photons are found does not depend on their order either.
class PhotonTree {
public:
    /// Takes the answer for points[point]; the arrays are good until it returns.
    using Consumer = std::function<void(std::size_t point, const GatheredPhotons& gathered)>;

    virtual ~PhotonTree() = default;

    /// Answers every point once, in an order of the tree's choice. A batch of points near each other (a
    /// tile's) is faster than one by one: what one query found bounds the next.
    virtual void gather(std::span<const ReceiverPoint> points, const GatherLimits& limits,
                        GatherScratch& scratch, const Consumer& consume) const = 0;
    virtual std::size_t size() const = 0;
    /// Memory held for the photons and their order.
    virtual std::uint64_t bytes() const = 0;
    virtual void add_to(Counters&) const {}
};

}  // namespace caustics::photonmap
