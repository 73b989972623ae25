#pragma once

#include "photonmap/tree/packed_kd_tree.h"

namespace caustics::photonmap {

/// One gather of a packed tree. A batch of points is halved until its parts are narrow against the
/// distance of the N-th photon; such a group's photons are collected by one walk round its
/// centre, exactly: with r the centre's distance and R the group's radius, the photons of all its members
/// lie within r + 2R of the centre, because a member's distance is at most r + R; those up to a margin beyond
/// the N-th, within that more.
class PackedGather {
public:
    PackedGather(const PackedKdTree& tree, const PackedKdTree::Batch& batch);

    void run();

private:
    using Group = std::span<std::uint32_t>;

    void answer(Group group);
    bool answer_together(Group group, const Box& box);
    void answer_one_by_one(Group group);
    bool collect(const Vec3& centre, const Vec3& normal, float radius, const SideTest* side);
    bool all_certain(Group group) const;
    bool all_count_at(Group group) const;
    void answer_member(std::uint32_t i, const Vec3& centre);
    void widen(NearestQuery& query, Candidates& found);
    void choose_among_ties(std::size_t nearest, Candidates& found, const CopiedPhotons& to) const;
    void copy_for_group(const Candidates& collected);
    template <typename Holds>
    bool holds_for_normals(Group group, const Holds& holds) const;

    const PackedKdTree& tree_;
    PackedKdTree::Batch batch_;
    float last_distance_ = 0;  ///< of the N-th photon in the answer before, or the maximum radius
    // Of a group.
    bool certain_ = false;       ///< whether all photons of the map count at all members
    bool tested_ = false;        ///< whether photons that do not count were left out
    float centre_distance_ = 0;  ///< within which the centre's N nearest lie
    CopiedPhotons columns_{};
    std::size_t column_count_ = 0;
};

}  // namespace caustics::photonmap
