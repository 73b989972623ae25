#include "experiments/base/signals.h"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

#include "core/base/interrupt.h"

namespace caustics::experiments {

namespace {

std::atomic<std::int64_t> requested_at{0};  ///< ms of the monotonic clock; 0: not yet
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

std::int64_t now() {
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return std::int64_t{time.tv_sec} * 1000 + time.tv_nsec / 1'000'000;
}

/// The first signal asks, a later one ends the process at once. timeout(1) sends two in one go,
/// which are one.
extern "C" void on_interrupt(int signal) {
    constexpr std::int64_t one_go = 1000;
    std::int64_t not_yet = 0;
    if (requested_at.compare_exchange_strong(not_yet, now())) {
        request_interrupt();
        return;
    }
    if (now() - requested_at < one_go) return;
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

}  // namespace

void catch_interrupts() {
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
}

}  // namespace caustics::experiments
