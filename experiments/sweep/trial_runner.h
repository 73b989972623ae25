#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "experiments/base/child_process.h"
#include "experiments/plan/reference_cache.h"
#include "experiments/plan/sweep_plan.h"
#include "experiments/plan/trial_store.h"

namespace caustics::experiments {

/// How trials are run.
struct TrialSettings {
    int jobs = 1;                    ///< at a time
    int threads = 0;                 ///< of a trial; 0: as the sweep file says
    Isa isa = widest_isa();          ///< of a trial
    double timeout = 0;              ///< seconds of a trial; 0: none
    std::uint64_t memory_bytes = 0;  ///< of a trial; 0: no limit

    int threads_of(const Trial& trial) const { return threads > 0 ? threads : trial.threads; }
};

/// Runs trials, each in a child process of its own, and puts what they leave behind into the store.
/// With room for several, each has processors of its own if there are enough.
class TrialRunner {
public:
    /// `before_storing` throws where the store is another's by now.
    TrialRunner(
        const TrialStore& store, ReferenceCache& references, const TrialSettings& settings,
        std::function<void()> before_storing = [] {});
    /// Kills the trials at work and forgets them.
    ~TrialRunner();
    TrialRunner(const TrialRunner&) = delete;
    TrialRunner& operator=(const TrialRunner&) = delete;

    bool has_room() const;
    void start(const Trial& trial);
    /// Puts a record of a trial that could not be started into the store.
    nlohmann::json refuse(const Trial& trial, const std::string& message) const;

    struct Finished {
        const Trial* trial;
        nlohmann::json record;
    };
    /// Waits for up to a fifth of a second; stores the trials that have ended, but those of status left.
    /// A trial that crashed, hung or ate memory is one of status failed or timeout. Throws InputError
    /// when the store cannot be written.
    std::vector<Finished> wait();

    struct Running {
        const Trial* trial;
        double seconds;
        double share;
    };
    std::vector<Running> running() const;

    /// The record of a trial that left nothing.
    nlohmann::json unfinished_record(const Trial& trial) const;

private:
    struct Slot {
        const Trial* trial;
        int place;  ///< among the jobs
        ChildProcess child;
    };
    nlohmann::json finish(const Trial& trial, const ChildProcess& child) const;
    void store(const Trial& trial, nlohmann::json& record, double seconds) const;

    const TrialStore& store_;
    ReferenceCache& references_;
    const TrialSettings& settings_;
    std::function<void()> before_storing_;
    std::vector<int> processors_;
    std::list<Slot> slots_;
};

}  // namespace caustics::experiments
