#include "photonmap/tree/gather_scratch.h"

namespace caustics::photonmap {

Candidates& CandidateArrays::reserve(std::size_t capacity) {
    if (capacity > candidates_.capacity) {
        squared_distance_.reserve(capacity + widest_register);
        index_.reserve(capacity + widest_register);
        candidates_ = {squared_distance_.data(), index_.data(), 0, capacity};
    }
    candidates_.count = 0;
    return candidates_;
}

void CopyArrays::reserve(std::size_t count, bool positions) {
    energy_.reserve(count + widest_register);
    direction_.reserve(count + widest_register);
    flags_.reserve(count + widest_register);
    if (!positions) return;
    for (auto& axis : position_) axis.reserve(count + widest_register);
}

CopiedPhotons CopyArrays::copied(bool positions, bool flags) {
    CopiedPhotons to{energy_.data(),
                     direction_.data(),
                     {nullptr, nullptr, nullptr},
                     flags ? flags_.data() : nullptr};
    if (positions)
        for (std::size_t axis = 0; axis < 3; ++axis) to.position[axis] = position_[axis].data();
    return to;
}

}  // namespace caustics::photonmap
