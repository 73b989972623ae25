#include "photonmap/nearest_set.h"

#include <algorithm>

namespace caustics {

namespace {

/// Puts `neighbour` in place of the heap's top and restores the heap.
void replace_top(std::vector<Neighbour>& heap, const Neighbour& neighbour) {
    std::size_t hole = 0;
    for (std::size_t child = 1; child < heap.size(); child = 2 * hole + 1) {
        if (child + 1 < heap.size() && heap[child] < heap[child + 1]) ++child;
        if (!(neighbour < heap[child])) break;
        heap[hole] = heap[child];
        hole = child;
    }
    heap[hole] = neighbour;
}

}  // namespace

void NearestSet::offer(const Neighbour& neighbour) {
    if (neighbour.squared_distance > bound_) return;
    if (!full()) {
        heap_.push_back(neighbour);
        std::push_heap(heap_.begin(), heap_.end());
    } else if (neighbour < heap_.front()) {
        replace_top(heap_, neighbour);
    }
    if (full()) bound_ = heap_.front().squared_distance;
}

}  // namespace caustics
