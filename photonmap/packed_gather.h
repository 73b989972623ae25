#pragma once

#include "photonmap/packed_kd_tree.h"

namespace caustics {

/// One gather of a packed tree. A batch of points is halved until its parts are narrow against the
/// distance of the N-th photon; such a group's photons are collected by one walk round its
/// centre, exactly: with r the centre's distance and R the group's radius, the photons of all its members
/// lie within r + 2R of the centre, because a member's distance is at most r + R.
class PackedGather {
public:
    PackedGather(const PackedKdTree& tree, std::span<const ReceiverPoint> points,
                 const GatherLimits& limits, GatherScratch& scratch,
                 const PhotonTree::Consumer& consume);

    void run();

private:
    using Group = std::span<std::uint32_t>;

    void answer(Group group);
    bool answer_together(Group group, const Box& box);
    void answer_one_by_one(Group group);
    void answer_member(std::uint32_t i, const Vec3& centre, float centre_distance);
    void choose_among_ties(std::size_t nearest, Candidates& found, const CopiedPhotons& to) const;
    bool may_share(Group group, bool& tested) const;
    PhotonColumns columns(std::size_t count);

    const PackedKdTree& tree_;
    std::span<const ReceiverPoint> points_;
    const GatherLimits& limits_;
    GatherScratch& scratch_;
    const PhotonTree::Consumer& consume_;
    NeighbourBound bound_;
    float last_distance_;  ///< of the N-th photon in the answer before, or the maximum radius
    bool tested_ = false;  ///< the group's side test
    PhotonColumns columns_{};
};

}  // namespace caustics
