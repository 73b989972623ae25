#include "photonmap/search_tree.h"

#include <algorithm>

namespace caustics {

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

void SearchTree::gather(std::span<const ReceiverPoint> points, const GatherLimits& limits,
                        GatherScratch& scratch, const Consumer& consume) const {
    make_room(limits, scratch);
    NeighbourBound bound;
    for (std::size_t i = 0; i < points.size(); ++i)
        answer(points, i, limits, bound, scratch, consume);
}

std::size_t SearchTree::nearest(const GatherLimits& limits) const {
    return std::max<std::size_t>(1, std::min(limits.nearest, size()));
}

void SearchTree::make_room(const GatherLimits& limits, GatherScratch& scratch) const {
    scratch.reserve(room_for(nearest(limits)), limits.positions);
}

NearestQuery SearchTree::query_at(const Vec3& point, const GatherLimits& limits) const {
    NearestQuery query{};
    std::copy_n(point.data(), 3, query.point);
    query.nearest = nearest(limits);
    query.max_squared_distance = limits.max_radius * limits.max_radius;
    query.tie_context = this;
    query.drop_ties = [](const void* tree, Candidates& found, std::size_t wanted) {
        const auto& self = *static_cast<const SearchTree*>(tree);
        keep_smallest_codes(found, wanted,
                            [&self](std::uint32_t photon) { return self.code_of(photon); });
    };
    return query;
}

void SearchTree::answer(std::span<const ReceiverPoint> points, std::size_t i,
                        const GatherLimits& limits, NeighbourBound& bound, GatherScratch& scratch,
                        const Consumer& consume) const {
    const ReceiverPoint& point = points[i];
    const Vec3& x = point.position;
    const Vec3& normal = point.geometric_normal;
    const bool tested = !directions_.all_in_front(normal);
    const SideTest side = side_test(normal);
    NearestQuery query = query_at(x, limits);
    query.max_squared_distance = bound.at(x, normal, tested, query.max_squared_distance);
    query.side = tested ? &side : nullptr;
    find(query, scratch);
    ++scratch.single_queries;
    const Candidates& found = scratch.found.candidates();
    const CopiedPhotons copied = scratch.copied(limits.positions);
    copy_out(found, copied);
    const GatheredPhotons answer = gathered(found, copied);
    if (answer.count == limits.nearest)
        bound.set(x, normal, tested, answer.squared_distance[answer.farthest]);
    else
        bound.forget();
    consume(i, answer);
}

GatheredPhotons SearchTree::gathered(const Candidates& found, const CopiedPhotons& copied) const {
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

}  // namespace caustics
