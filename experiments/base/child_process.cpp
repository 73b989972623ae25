#include "experiments/base/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <mutex>
#include <new>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "experiments/base/file_io.h"

namespace caustics::experiments {

namespace {

// A message is a letter; a share is followed by its bytes, anything else by text up to the end.
constexpr char share_letter = 's';
constexpr char answer_letter = 'a';
constexpr char bad_input_letter = 'i';
constexpr char unsupported_letter = 'u';
constexpr char threw_letter = 'e';

/// Those that ask a process to end.
constexpr int end_signals[] = {SIGINT, SIGTERM, SIGHUP};

[[noreturn]] void fail_call(const char* what) {
    throw std::system_error(errno, std::generic_category(), what);
}

/// Threads of this process; 0 where there is no /proc to count them by.
std::size_t thread_count() {
    std::error_code none;
    const std::filesystem::directory_iterator threads("/proc/self/task", none);
    return static_cast<std::size_t>(std::distance(begin(threads), end(threads)));
}

const std::size_t threads_at_start = thread_count();

void require_no_other_thread() {
    if (threads_at_start > 0 && thread_count() > threads_at_start)
        throw std::logic_error("a child must be forked before any thread begins");
}

void write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) _exit(1);  // the reader is gone
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

/// Sends shares no more often than somebody can read them.
class Teller {
public:
    explicit Teller(int pipe) : pipe_(pipe) {}
    void operator()(double share) {
        constexpr std::chrono::milliseconds interval(100);
        const auto now = std::chrono::steady_clock::now();
        const std::scoped_lock lock(mutex_);
        if (now - last_ < interval) return;
        last_ = now;
        std::string message(1 + sizeof share, share_letter);
        std::memcpy(&message[1], &share, sizeof share);
        write_all(pipe_, message);
    }

private:
    int pipe_;
    std::mutex mutex_;
    std::chrono::steady_clock::time_point last_;
};

/// When the system runs out of memory it is to end this process, not the one that waits for it.
void offer_for_sacrifice() { std::ofstream("/proc/self/oom_score_adj") << 1000; }

std::uint64_t resident_bytes_of(pid_t process) {
    // proc(5): size and resident set in pages.
    std::ifstream in(fmt::format("/proc/{}/statm", process));
    std::uint64_t size = 0;
    std::uint64_t resident = 0;
    in >> size >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void run_on(const std::vector<int>& processors) {
    if (processors.empty()) return;
    cpu_set_t set;
    CPU_ZERO(&set);
    for (const int processor : processors) CPU_SET(static_cast<std::size_t>(processor), &set);
    if (sched_setaffinity(0, sizeof set, &set) != 0) fail_call("sched_setaffinity");
}

void print_to(const std::filesystem::path& log) {
    if (log.empty()) return;
    const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
    if (file < 0)
        throw InputError(fmt::format("{}: cannot be written ({})", log.string(),
                                     std::generic_category().message(errno)));
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    close(file);
}

/// The letter and the text that the work ends with.
std::string last_message(const ChildProcess::Work& work, const ChildLimits& limits,
                         const std::filesystem::path& log, int pipe) {
    try {
        print_to(log);
        run_on(limits.processors);
        offer_for_sacrifice();
        Teller teller(pipe);
        return answer_letter + work([&](double share) { teller(share); });
    } catch (const InputError& error) {
        return std::string(1, bad_input_letter) + error.what();
    } catch (const UnsupportedScene& error) {
        return std::string(1, unsupported_letter) + error.what();
    } catch (const std::filesystem::filesystem_error& error) {
        return std::string(1, bad_input_letter) + reason_of(error);
    } catch (const std::bad_alloc&) {
        return std::string(1, threw_letter) + "out of memory";
    } catch (const std::exception& error) {
        return std::string(1, threw_letter) + error.what();
    } catch (...) {
        return std::string(1, threw_letter) + "an exception of a library";
    }
}

/// No signal that asks to end comes while this lives: one that does comes afterwards.
class InterruptsHeld {
public:
    InterruptsHeld() {
        sigset_t held;
        sigemptyset(&held);
        for (const int signal : end_signals) sigaddset(&held, signal);
        pthread_sigmask(SIG_BLOCK, &held, &before_);
    }
    ~InterruptsHeld() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    InterruptsHeld(const InterruptsHeld&) = delete;
    InterruptsHeld& operator=(const InterruptsHeld&) = delete;

private:
    sigset_t before_{};
};

[[noreturn]] void be_child(const ChildProcess::Work& work, const ChildLimits& limits,
                           const std::filesystem::path& log, int pipe, pid_t parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    // The parent ends its children; what it was asked before is not for them.
    for (const int signal : end_signals) std::signal(signal, SIG_IGN);
    forget_interrupt();
    try {
        write_all(pipe, last_message(work, limits, log, pipe));
        std::fflush(nullptr);
    } catch (...) {
        // No memory to say why. The way back is through the parent's own work.
        write_all(pipe, std::string_view("eout of memory"));
    }
    _exit(0);
}

ChildEnd::How how(char letter) {
    switch (letter) {
        case answer_letter: return ChildEnd::How::answered;
        case bad_input_letter: return ChildEnd::How::bad_input;
        case unsupported_letter: return ChildEnd::How::unsupported;
        default: return ChildEnd::How::threw;
    }
}

std::string death(int status) {
    if (!WIFSIGNALED(status))
        return fmt::format("ended without an answer (exit code {})", WEXITSTATUS(status));
    const int signal = WTERMSIG(status);
    const char* const hint =
        signal == SIGKILL ? ": by hand, or by the system when memory ran out" : "";
    return fmt::format("killed by signal {} ({}){}", signal, strsignal(signal), hint);
}

}  // namespace

ChildProcess::ChildProcess(const Work& work, const ChildLimits& limits,
                           const std::filesystem::path& log)
    : limit_seconds_(limits.seconds),
      limit_bytes_(limits.memory_bytes),
      start_(Clock::now()),
      stop_(start_) {
    require_no_other_thread();
    std::fflush(nullptr);  // or the child would print it again
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) fail_call("pipe");
    const pid_t parent = getpid();
    const InterruptsHeld held;  // or the child would end like its parent
    process_ = fork();
    if (process_ < 0) {
        close(ends[0]);
        close(ends[1]);
        fail_call("fork");
    }
    if (process_ == 0) {
        close(ends[0]);
        be_child(work, limits, log, ends[1], parent);
    }
    close(ends[1]);
    pipe_ = ends[0];
    fcntl(pipe_, F_SETFL, O_NONBLOCK);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      pipe_(std::exchange(other.pipe_, -1)),
      pipe_open_(other.pipe_open_),
      limit_seconds_(other.limit_seconds_),
      limit_bytes_(other.limit_bytes_),
      start_(other.start_),
      stop_(other.stop_),
      share_(other.share_),
      received_(std::move(other.received_)),
      end_(std::move(other.end_)) {}

ChildProcess::~ChildProcess() {
    if (process_ > 0) {
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }
    if (pipe_ >= 0) close(pipe_);
}

double ChildProcess::seconds() const {
    const Clock::time_point until = process_ > 0 ? Clock::now() : stop_;
    return std::chrono::duration<double>(until - start_).count();
}

void ChildProcess::read_pipe() {
    char buffer[1 << 16];
    while (pipe_open_) {
        const ssize_t count = read(pipe_, buffer, sizeof buffer);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return;  // nothing more for now
        if (count == 0) pipe_open_ = false;
        received_.append(buffer, static_cast<std::size_t>(count));
    }
}

bool ChildProcess::has_ended() {
    if (process_ < 0) return true;
    read_pipe();
    constexpr std::size_t message = 1 + sizeof share_;
    while (received_.size() >= message && received_[0] == share_letter) {
        std::memcpy(&share_, &received_[1], sizeof share_);
        received_.erase(0, message);
    }
    if (!pipe_open_)
        reap();
    else if (limit_seconds_ > 0 && seconds() > limit_seconds_)
        give_up({ChildEnd::How::timed_out, fmt::format("no result after {} s", limit_seconds_)});
    else if (limit_bytes_ > 0 && resident_bytes_of(process_) > limit_bytes_)
        give_up({ChildEnd::How::too_large,
                 fmt::format("took more than {} MiB of memory", limit_bytes_ >> 20)});
    return process_ < 0;
}

int ChildProcess::patience() const {
    constexpr int longest = 200;
    constexpr int between_looks_at_memory = 20;  // a thread fills some 40 MB in that time
    const double left = limit_seconds_ > 0 ? 1000 * (limit_seconds_ - seconds()) : longest;
    return std::clamp(static_cast<int>(left) + 1, 1,
                      limit_bytes_ > 0 ? between_looks_at_memory : longest);
}

void ChildProcess::reap() {
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {}
    stop_ = Clock::now();
    process_ = -1;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && !received_.empty())
        end_ = {how(received_[0]), received_.substr(1)};
    else
        end_ = {ChildEnd::How::died, death(status)};
}

void ChildProcess::give_up(ChildEnd end) {
    kill(process_, SIGKILL);
    reap();
    end_ = std::move(end);
}

std::vector<int> own_processors() {
    cpu_set_t set;
    std::vector<int> processors;
    if (sched_getaffinity(0, sizeof set, &set) != 0) return processors;
    for (int processor = 0; processor < CPU_SETSIZE; ++processor)
        if (CPU_ISSET(static_cast<std::size_t>(processor), &set)) processors.push_back(processor);
    return processors;
}

void wait_for_any(const std::vector<ChildProcess*>& children) {
    if (children.empty()) return;
    int patience = 1000;
    std::vector<pollfd> all;
    for (const ChildProcess* child : children) {
        all.push_back({child->descriptor(), POLLIN, 0});
        patience = std::min(patience, child->patience());
    }
    poll(all.data(), all.size(), patience);
}

std::string run_in_child(const ChildProcess::Work& work, const ChildProcess::Tell& tell) {
    ChildProcess child(work);
    while (!child.has_ended()) {
        throw_if_interrupted();
        if (tell) tell(child.share());
        wait_for_any({&child});
    }
    throw_if_interrupted();
    const ChildEnd& end = child.end();
    switch (end.how) {
        case ChildEnd::How::answered: return end.text;
        case ChildEnd::How::bad_input: throw InputError(end.text);
        case ChildEnd::How::unsupported: throw UnsupportedScene(end.text);
        default: throw std::runtime_error(end.text);
    }
}

}  // namespace caustics::experiments
