#include "photonmap/estimate/adaptive_n.h"

#include <algorithm>

#include "core/math/frame.h"
#include "photonmap/tree/kd_tree_base.h"

namespace caustics::photonmap {

namespace {

/// The mean of the factor over even directions when 1, 2, ... steps of the ladder can be tested; by
/// ten million random sequences, to 3e-5 (adaptive_count_test.cpp draws its own).
constexpr double mean_factors[] = {1,        0.999755, 0.999345, 0.998715, 0.998216, 0.997794,
                                   0.997520, 0.997334, 0.997232, 0.997192, 0.997184};

double mean_factor(std::size_t rungs) {
    return rungs == 0 ? 1 : mean_factors[std::min(rungs, std::size(mean_factors)) - 1];
}

}  // namespace

AdaptiveN::AdaptiveN(Isa isa) : chooser_(tree_kernels(isa).choose_count) {}

ChosenPhotons AdaptiveN::choose(const ReceiverPoint& point, const GatheredPhotons& gathered,
                                bool full, NScratch& scratch) const {
    const std::size_t room = gathered.count + widest_register;
    PhotonsAround around{};
    if (gathered.count > 0)
        around.greatest_squared_distance = gathered.squared_distance[gathered.farthest];
    around.squared_distance = gathered.squared_distance;
    around.count = gathered.count;
    std::ranges::copy(gathered.position, around.position);
    const Frame frame(point.geometric_normal);
    std::copy_n(point.position.data(), 3, around.point);
    std::copy_n(frame.s.data(), 3, around.tangent);
    std::copy_n(frame.t.data(), 3, around.bitangent);
    for (std::size_t part = 0; part < 4; ++part) {
        scratch.direction[part].reserve(room);
        around.direction[part] = scratch.direction[part].data();
    }
    const NChoice choice = chooser_(around);

    const double mean = mean_factor(choice.rungs);
    if (!choice.stopped) return {gathered, full, 1 / mean};
    return {scratch.near.within(gathered, choice.squared_radius), true,
            std::min(1.0, 1.5 * (1 - choice.lean)) / mean};
}

}  // namespace caustics::photonmap
