#include "core/picture/confinement.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/seccomp.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <functional>
#include <thread>
#include <vector>

#include "tests/support/sanitizers.h"

namespace caustics {
namespace {

/// True where work() holds in a process that is confined.
bool holds_in_confinement(const std::function<bool()>& work) {
    const pid_t child = fork();
    if (child == 0) {
        confine_this_process();
        _exit(work() ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// True where the system lets a process have a filter of calls: it names a null filter a bad address then.
bool has_filters() {
#if defined(__x86_64__) || defined(__aarch64__)
    return syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, nullptr) < 0 && errno == EFAULT;
#else
    return false;
#endif
}

bool is_refused(long result) { return result < 0 && errno == EPERM; }

TEST(Confinement, TakesFilesProgramsAndOtherProcesses) {
    if (CAUSTICS_ADDRESS_SANITIZER || CAUSTICS_THREAD_SANITIZER)
        GTEST_SKIP() << "sanitizers open files";
    if (!has_filters())
        GTEST_SKIP()
            << "no filter of calls (seccomp) on this processor or system: decoding is not confined";
    EXPECT_TRUE(holds_in_confinement([] { return is_refused(open("/dev/null", O_RDONLY)); }));
    EXPECT_TRUE(holds_in_confinement([] { return is_refused(unlink("/nothing/here")); }));
    EXPECT_TRUE(holds_in_confinement([] { return is_refused(socket(AF_INET, SOCK_STREAM, 0)); }));
    EXPECT_TRUE(holds_in_confinement([] {
        char* const words[] = {nullptr};
        return is_refused(execve("/bin/true", words, words));
    }));
    const pid_t other = getpid();
    EXPECT_TRUE(holds_in_confinement([&] { return is_refused(kill(other, 0)); }));
    EXPECT_TRUE(holds_in_confinement([] { return is_refused(fork()); }));
}

TEST(Confinement, LeavesMemoryThreadsAndWhatIsOpen) {
    if (CAUSTICS_THREAD_SANITIZER) GTEST_SKIP() << "its threads do not survive fork()";
    int ends[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    EXPECT_TRUE(holds_in_confinement([&] {
        std::vector<char> large(50'000'000, 'x');
        std::thread([&] { large.back() = 'y'; }).join();
        return send(ends[1], &large.back(), 1, 0) == 1;
    }));
    char heard = 0;
    EXPECT_EQ(recv(ends[0], &heard, 1, 0), 1);
    EXPECT_EQ(heard, 'y');
    for (const int end : ends) close(end);
}

}  // namespace
}  // namespace caustics
