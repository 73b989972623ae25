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
    query.max_squared_distance = limits.max_radius * limits.max_radius;
    query.tie_context = this;
    query.drop_ties = [](const void* tree, Candidates& found, std::size_t wanted) {
        const auto& self = *static_cast<const KdTreeBase*>(tree);
        keep_smallest_codes(found, wanted,
                            [&self](std::uint32_t photon) { return self.code_of(photon); });
    };
    batch.scratch.reserve(room_for(query.nearest), limits.positions);
}

NearestQuery KdTreeBase::Batch::query_at(const Vec3& point) const {
    NearestQuery at = query;
    std::copy_n(point.data(), 3, at.point);
    return at;
}

void KdTreeBase::answer(Batch& batch, std::size_t i) const {
    const GatherLimits& limits = batch.limits;
    GatherScratch& scratch = batch.scratch;
    NeighbourBound& bound = batch.bound;
    const Vec3& x = batch.points[i].position;
    const Vec3& normal = batch.points[i].geometric_normal;
    const Candidates& found = scratch.found.candidates();
    const bool certain = directions_.all_count(normal);
    const CopiedPhotons copied = scratch.copies.copied(limits.positions, !certain);
    const auto find_all = [&](const SideTest* side) {
        NearestQuery query = batch.query_at(x);
        query.max_squared_distance =
            bound.at(x, normal, side != nullptr, query.max_squared_distance);
        query.side = side;
        find(query, scratch);
        copy_out(found, copied);
    };
    if (certain) {
        find_all(nullptr);
    } else {
        // Where all of the nearest count, they need no test one by one.
        const SideTest side = side_test(normal);
        if (!bound.met_foreign()) find_all(nullptr);
        if (bound.met_foreign() || !all_count(side, copied, found.count)) {
            bound.meet_foreign();
            find_all(&side);
        }
    }
    ++scratch.single_queries;
    const GatheredPhotons answer = gathered(found, copied);
    if (answer.count == limits.nearest)
        bound.set(x, normal, answer.squared_distance[answer.farthest]);
    else
        bound.forget();
    batch.consume(i, answer);
}

GatheredPhotons KdTreeBase::gathered(const Candidates& found, const CopiedPhotons& copied) const {
    GatheredPhotons answer{found.squared_distance,
                           copied.energy,
                           copied.direction,
                           found.count,
                           0,
                           {copied.position[0], copied.position[1], copied.position[2]}};
    if (found.count == 0) return answer;
    const Farthest farthest = kernels_.farthest(found);
    answer.farthest = farthest.place;
    if (farthest.alone) return answer;
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
