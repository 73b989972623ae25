#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

namespace caustics::experiments {

/// Seconds of a stretch of work: on the wall and summed over the process's threads.
struct Seconds {
    double wall = 0;
    double cpu = 0;

    Seconds& operator+=(const Seconds& other);
    friend Seconds operator-(const Seconds& a, const Seconds& b);
};

/// CPU seconds that this process has used since it began, with those of its ended children.
double cpu_seconds_used();

/// Cuts a run into consecutive named phases. A phase may come again; its times add up. Thread-safe.
class Stopwatch {
public:
    Stopwatch();
    /// Ends the current phase and begins another.
    void begin(std::string_view phase);
    /// Ends the current phase.
    void stop();

    /// Of a phase that ended; zero when it never began.
    Seconds of(const std::string& phase) const;
    /// The phase of that name and those below it ("render", "render/PHASE"), as far as they ended.
    Seconds of_stage(const std::string& stage) const;
    Seconds worked() const;  ///< of all phases that ended
    Seconds total() const;   ///< since construction
    const std::map<std::string, Seconds>& phases() const { return phases_; }

private:
    static Seconds now();
    void end_phase(const Seconds& at);

    mutable std::mutex mutex_;
    std::map<std::string, Seconds> phases_;
    std::string current_;
    Seconds start_;
    Seconds begun_;
};

}  // namespace caustics::experiments
