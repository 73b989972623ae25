#include "core/base/interrupt.h"

#include <atomic>

#include "core/base/error.h"

namespace caustics {

namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

void request_interrupt() { requested.store(true, std::memory_order_relaxed); }

bool interrupt_requested() { return requested.load(std::memory_order_relaxed); }

void forget_interrupt() { requested.store(false, std::memory_order_relaxed); }

void throw_if_interrupted() {
    if (interrupt_requested()) throw Interrupted();
}

}  // namespace caustics
