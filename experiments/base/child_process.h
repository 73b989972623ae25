#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace caustics::experiments {

/// What a child process may use; 0 or empty: no limit.
struct ChildLimits {
    double seconds = 0;              ///< on the wall
    std::uint64_t memory_bytes = 0;  ///< in memory at a time, the program's own included
    std::vector<int> processors;     ///< to run on
};

/// How a child ended.
struct ChildEnd {
    enum class How {
        answered,
        bad_input,    ///< the work threw InputError
        unsupported,  ///< ... UnsupportedScene
        threw,        ///< ... anything else
        died,         ///< by a signal, or without a word
        timed_out,
        too_large  ///< took more memory than it may
    };
    How how = How::died;
    std::string text;  ///< the answer, what() of the exception, or how it died
};

/// Work in a process of its own: a crash, a hang, its memory and its threads are not this one's.
/// The child is a fork, so it begins with all that this process knows; it must be forked
/// before this one begins a thread (throws std::logic_error otherwise). It ends with this process, however
/// that ends, and SIGINT and SIGTERM are this process's business alone.
class ChildProcess {
public:
    /// Tells the parent the done share of the work.
    using Tell = std::function<void(double share)>;
    using Work = std::function<std::string(const Tell& tell)>;

    /// Begins the work. What the child prints is added to the file `log`, where one is named.
    explicit ChildProcess(const Work& work, const ChildLimits& limits = {},
                          const std::filesystem::path& log = {});
    /// Kills the child if it still runs.
    ~ChildProcess();
    ChildProcess(ChildProcess&& other) noexcept;
    ChildProcess& operator=(ChildProcess&& other) = delete;

    /// Reads what the child wrote, without waiting; kills it when its time is over or its memory too
    /// large. True when it has ended.
    bool has_ended();
    /// Milliseconds after which has_ended() should be asked again, though nothing was written.
    int patience() const;
    /// How it ended; only when it has.
    const ChildEnd& end() const { return end_; }
    double share() const { return share_; }   ///< as last reported
    double seconds() const;                   ///< since it began, until its end
    int descriptor() const { return pipe_; }  ///< becomes readable when there is something to do
    pid_t id() const { return process_; }

private:
    void read_pipe();
    void reap();
    void give_up(ChildEnd end);

    using Clock = std::chrono::steady_clock;
    pid_t process_ = -1;
    int pipe_ = -1;
    bool pipe_open_ = true;
    double limit_seconds_ = 0;
    std::uint64_t limit_bytes_ = 0;
    Clock::time_point start_;
    Clock::time_point stop_;
    double share_ = 0;
    std::string received_;
    ChildEnd end_;
};

/// The processors this process may run on.
std::vector<int> own_processors();

/// Waits until one of the children has something to tell, a signal comes, or the patience with one is
/// over.
void wait_for_any(const std::vector<ChildProcess*>& children);

/// Runs the work in a child and waits for it; `tell` hears of the done share. Throws what the work
/// threw (anything but InputError and UnsupportedScene as std::runtime_error, as well as a child
/// that died), and Interrupted, having killed the child, when somebody asked this process to stop.
std::string run_in_child(const ChildProcess::Work& work, const ChildProcess::Tell& tell = {});

}  // namespace caustics::experiments
