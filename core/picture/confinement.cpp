#include "core/picture/confinement.h"

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace caustics {
namespace {

#if defined(__x86_64__)
constexpr std::uint32_t own_architecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t own_architecture = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t own_architecture = 0;
#endif

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool is_sanitized = true;  // sanitizers read /proc
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif
#else
constexpr bool is_sanitized = false;
#endif

/// Calls of the kernel that decoding needs, but that which starts threads: open files, memory, time and the end.
constexpr auto allowed_calls = std::to_array<long>({
    SYS_read,           SYS_write,
    SYS_recvfrom,       SYS_sendto,
    SYS_close,          SYS_lseek,
    SYS_fstat,          SYS_brk,
    SYS_mmap,           SYS_munmap,
    SYS_mremap,         SYS_mprotect,
    SYS_madvise,        SYS_futex,
    SYS_sched_yield,    SYS_set_robust_list,
    SYS_rseq,           SYS_sched_getaffinity,
    SYS_rt_sigprocmask, SYS_rt_sigaction,
    SYS_rt_sigreturn,   SYS_sigaltstack,
    SYS_getpid,         SYS_gettid,
    SYS_clock_gettime,  SYS_clock_nanosleep,
    SYS_nanosleep,      SYS_gettimeofday,
    SYS_getrandom,      SYS_restart_syscall,
    SYS_exit,           SYS_exit_group,
});

constexpr sock_filter load(std::uint32_t at) { return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, at); }
constexpr sock_filter result(std::uint32_t value) { return BPF_STMT(BPF_RET | BPF_K, value); }
/// The next instruction, or the one after it where the loaded number is another.
constexpr sock_filter next_if(std::uint32_t value) {
    return BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, 1);
}

/// `clone` starts threads and no process. `clone3` hides its flags from a filter: where it is missing, libraries take
/// `clone`.
std::vector<sock_filter> thread_filter() {
    constexpr std::uint32_t low_word_of_flags = offsetof(seccomp_data, args);  // little-endian
    return {next_if(SYS_clone3),
            result(SECCOMP_RET_ERRNO | ENOSYS),
            BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clone, 0, 4),
            load(low_word_of_flags),
            BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, CLONE_THREAD, 0, 1),
            result(SECCOMP_RET_ALLOW),
            result(SECCOMP_RET_ERRNO | EPERM)};
}

std::vector<sock_filter> call_filter() {
    // In another architecture the numbers mean other calls.
    std::vector<sock_filter> filter = {load(offsetof(seccomp_data, arch)),
                                       next_if(own_architecture), BPF_STMT(BPF_JMP | BPF_JA, 1),
                                       result(SECCOMP_RET_KILL_PROCESS),
                                       load(offsetof(seccomp_data, nr))};
    for (const long call : allowed_calls) {
        filter.push_back(next_if(static_cast<std::uint32_t>(call)));
        filter.push_back(result(SECCOMP_RET_ALLOW));
    }
    const std::vector<sock_filter> threads = thread_filter();
    filter.insert(filter.end(), threads.begin(), threads.end());
    filter.push_back(result(SECCOMP_RET_ERRNO | EPERM));
    return filter;
}

}  // namespace

void confine_this_process() {
    if (is_sanitized || own_architecture == 0) return;
    std::vector<sock_filter> filter = call_filter();
    const sock_fprog program = {static_cast<unsigned short>(filter.size()), filter.data()};
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &program);
}

}  // namespace caustics
