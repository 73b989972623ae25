#include "photonmap/gather_scratch.h"

namespace caustics {

Candidates& CandidateArrays::reserve(std::size_t capacity) {
    constexpr std::size_t widest_register = 16;
    if (capacity > candidates_.capacity) {
        squared_distance_.reserve(capacity + widest_register);
        index_.reserve(capacity + widest_register);
        candidates_ = {squared_distance_.data(), index_.data(), 0, capacity};
    }
    candidates_.count = 0;
    return candidates_;
}

}  // namespace caustics
