#pragma once

#include <nlohmann/json_fwd.hpp>

namespace caustics::experiments {

/// How busy the machine is with other work than this process's, from construction to record().
class MachineLoad {
public:
    MachineLoad();

    /// "average": runnable processes over the last minute, when it began (/proc/loadavg);
    /// "other_cores": processors that other processes kept busy on average (from /proc/stat, which
    /// counts in hundredths of a second: left out for less than a fifth of a second).
    nlohmann::json record() const;

private:
    struct Moment {
        double wall = 0;  ///< seconds
        double own = 0;   ///< seconds of this process on all processors
        double all = 0;   ///< seconds of all processes
    };
    static Moment now();

    double average_;
    Moment start_;
};

}  // namespace caustics::experiments
