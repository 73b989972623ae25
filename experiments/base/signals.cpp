#include "experiments/base/signals.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <string_view>
#include <tuple>

#include <unistd.h>

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

constexpr long patience =
    500'000'000;  // ns; ending a process of many gigabytes takes its time, too
timer_t last_moment{};
std::atomic<bool> has_last_moment{false};
bool is_on_terminal = false;

/// In a process that was forked since there is no such timer: nothing happens.
void set_last_moment(long nanoseconds) {
    const itimerspec once{{0, 0}, {0, nanoseconds}};
    if (has_last_moment) timer_settime(last_moment, 0, &once, nullptr);
}

extern "C" void on_last_moment(int /*signal*/) {
    if (!has_last_moment.exchange(false)) return;
    constexpr std::string_view clear_line = "\r\033[K";
    constexpr std::string_view report = "causticbench: error: interrupted\n";
    if (is_on_terminal) std::ignore = write(STDERR_FILENO, clear_line.data(), clear_line.size());
    std::ignore = write(STDERR_FILENO, report.data(), report.size());
    constexpr int interrupted = 130;
    _exit(interrupted);
}

/// The first signal asks, a later one ends the process at once. timeout(1) sends two in one go,
/// which are one.
extern "C" void on_interrupt(int signal) {
    constexpr std::int64_t one_go = 1000;
    std::int64_t not_yet = 0;
    if (requested_at.compare_exchange_strong(not_yet, now())) {
        request_interrupt();
        const int error = errno;
        set_last_moment(patience);
        errno = error;
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
    if (std::signal(SIGHUP, on_interrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

void end_soon_after_interrupts() {
    std::signal(SIGALRM, on_last_moment);
    sigevent by_alarm{};
    by_alarm.sigev_notify = SIGEV_SIGNAL;
    by_alarm.sigev_signo = SIGALRM;
    is_on_terminal = isatty(STDERR_FILENO) == 1;
    has_last_moment = timer_create(CLOCK_MONOTONIC, &by_alarm, &last_moment) == 0;
    if (interrupt_requested()) set_last_moment(patience);
}

void end_in_own_time() { has_last_moment = false; }

}  // namespace caustics::experiments
