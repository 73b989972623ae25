#include "photonmap/tree/kd_tree_base.h"

#include <algorithm>

namespace caustics::photonmap {

const TreeKernels& tree_kernels(Isa isa) {
#ifdef CAUSTICS_X86_KERNELS
    if (isa == Isa::avx512) return avx512_tree_kernels();
    if (isa == Isa::avx2) return avx2_tree_kernels();
#endif
    (void)isa;
    return plain_tree_kernels();
}

unsigned widest_axis(std::span<const Photon> photons, const TreeKernels& kernels) {
    float least[3], greatest[3];
    kernels.bounds(reinterpret_cast<const unsigned char*>(photons.data()), photons.size(), least,
                   greatest);
    unsigned widest = 0;
    for (unsigned axis = 1; axis < 3; ++axis)
        if (greatest[axis] - least[axis] > greatest[widest] - least[widest]) widest = axis;
    return widest;
}

void KdTreeBase::gather(std::span<const ReceiverPoint> points, const GatherLimits& limits,
                        GatherScratch& scratch, const Consumer& consume) const {
    Batch batch{points, limits, scratch, consume};
    begin(batch);
    for (std::size_t i = 0; i < points.size(); ++i) answer(batch, i);
}

std::size_t KdTreeBase::nearest(const GatherLimits& limits) const {
    return std::max<std::size_t>(1, std::min(limits.nearest, size()));
}

void KdTreeBase::begin(Batch& batch) const {
    const GatherLimits& limits = batch.limits;
    NearestQuery& query = batch.query;
    query.nearest = nearest(limits);
    const bool all = limits.nearest == GatherLimits::all;
    batch.max_radius = limits.max_radius + (all ? limits.margin : 0);
    batch.margin = all ? 0 : limits.margin;
    query.max_squared_distance = batch.max_radius * batch.max_radius;
    query.tie_context = this;
    query.drop_ties = [](const void* tree, Candidates& found, std::size_t wanted) {
        const auto& self = *static_cast<const KdTreeBase*>(tree);
        keep_smallest_codes(found, wanted,
                            [&self](std::uint32_t photon) { return self.code_of(photon); });
    };
    batch.scratch.reserve(room_for(batch.margin > 0 ? size() : query.nearest), limits.positions);
}

NearestQuery KdTreeBase::Batch::query_at(const Vec3& point) const {
    NearestQuery at = query;
    std::copy_n(point.data(), 3, at.point);
    return at;
}

// Finds the N nearest first, because the margin begins at the N-th.
void KdTreeBase::find_all(Batch& batch, std::size_t i, const SideTest* side,
                          const CopiedPhotons& copied) const {
    const ReceiverPoint& point = batch.points[i];
    const Candidates& found = batch.scratch.found.candidates();
    NearestQuery query = batch.query_at(point.position);
    query.max_squared_distance = batch.bound.at(point.position, point.geometric_normal,
                                                side != nullptr, query.max_squared_distance);
    query.side = side;
    find(query, batch.scratch);
    if (batch.margin > 0) {
        const bool full = found.count == batch.limits.nearest;
        batch.nth = full ? found.squared_distance[kernels_.farthest(found).place] : -1;
        query.nearest = size();
        query.max_squared_distance = batch.reach();
        find(query, batch.scratch);
    }
    copy_out(found, copied);
}

void KdTreeBase::answer(Batch& batch, std::size_t i) const {
    GatherScratch& scratch = batch.scratch;
    NeighbourBound& bound = batch.bound;
    const Vec3& normal = batch.points[i].geometric_normal;
    const Candidates& found = scratch.found.candidates();
    const bool certain = directions_.all_count(normal);
    const CopiedPhotons copied = scratch.copies.copied(batch.limits.positions, !certain);
    if (certain) {
        find_all(batch, i, nullptr, copied);
    } else {
        // Where all of the nearest count, they need no test one by one.
        const SideTest side = side_test(normal);
        if (!bound.met_foreign()) find_all(batch, i, nullptr, copied);
        if (bound.met_foreign() || !all_count(side, copied, found.count)) {
            bound.meet_foreign();
            find_all(batch, i, &side, copied);
        }
    }
    ++scratch.single_queries;
    const GatheredPhotons answer = gathered(batch, found, copied);
    renew_bound(batch, i, answer);
    batch.consume(i, answer);
}

void KdTreeBase::renew_bound(Batch& batch, std::size_t i, const GatheredPhotons& answer) {
    const ReceiverPoint& point = batch.points[i];
    if (answer.full)
        batch.bound.set(point.position, point.geometric_normal,
                        answer.squared_distance[answer.farthest]);
    else
        batch.bound.forget();
}

GatheredPhotons KdTreeBase::gathered(const Batch& batch, const Candidates& found,
                                     const CopiedPhotons& copied) const {
    GatheredPhotons answer{found.squared_distance,
                           copied.energy,
                           copied.direction,
                           found.count,
                           0,
                           {copied.position[0], copied.position[1], copied.position[2]},
                           batch.margin > 0 ? batch.nth >= 0 : found.count == batch.limits.nearest};
    if (found.count == 0) return answer;
    if (batch.margin > 0) {
        if (!answer.full) return answer;
        while (answer.squared_distance[answer.farthest] != batch.nth) ++answer.farthest;
    } else {
        const Farthest farthest = kernels_.farthest(found);
        answer.farthest = farthest.place;
        if (farthest.alone) return answer;
    }
    const auto code_at = [&answer](std::size_t i) {
        return code(answer.energy[i], answer.direction[i]);
    };
    for (std::size_t i = answer.farthest + 1; i < answer.count; ++i)
        if (answer.squared_distance[i] == answer.squared_distance[answer.farthest] &&
            code_at(i) > code_at(answer.farthest))
            answer.farthest = i;
    return answer;
}

}  // namespace caustics::photonmap
