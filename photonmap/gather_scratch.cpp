#include "photonmap/gather_scratch.h"

namespace caustics {

namespace {
constexpr std::size_t widest_register = 16;
}

Candidates& CandidateArrays::reserve(std::size_t capacity) {
    if (capacity > candidates_.capacity) {
        squared_distance_.reserve(capacity + widest_register);
        index_.reserve(capacity + widest_register);
        candidates_ = {squared_distance_.data(), index_.data(), 0, capacity};
    }
    candidates_.count = 0;
    return candidates_;
}

void GatherScratch::reserve(std::size_t count, bool positions) {
    found.reserve(count);
    energy.reserve(count + widest_register);
    direction.reserve(count + widest_register);
    if (!positions) return;
    for (auto& axis : position) axis.reserve(count + widest_register);
}

CopiedPhotons GatherScratch::copied(bool positions) {
    CopiedPhotons to{energy.data(), direction.data(), {nullptr, nullptr, nullptr}};
    if (positions)
        for (std::size_t axis = 0; axis < 3; ++axis) to.position[axis] = position[axis].data();
    return to;
}

}  // namespace caustics
