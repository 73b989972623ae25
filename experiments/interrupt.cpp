#include "experiments/interrupt.h"

#include <atomic>
#include <csignal>

#include "core/error.h"

namespace caustics {

namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void on_interrupt(int signal) {
    requested = true;
    std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
}

bool interrupt_requested() { return requested; }

void throw_if_interrupted() {
    if (requested) throw Interrupted();
}

}  // namespace caustics
