#include "experiments/base/machine_load.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace caustics::experiments {

namespace {

/// Seconds that all processors were busy since the start of the system.
double busy_seconds() {
    std::ifstream in("/proc/stat");
    std::string label;
    in >> label;
    // proc(5): user, nice, system, idle, iowait, irq, softirq, steal; guests are part of user.
    double ticks = 0;
    double value = 0;
    for (int field = 0; field < 8 && in >> value; ++field)
        if (field != 3 && field != 4) ticks += value;
    return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double load_average() {
    double average = 0;
    std::ifstream("/proc/loadavg") >> average;
    return average;
}

}  // namespace

MachineLoad::MachineLoad() : average_(load_average()), start_(now()) {}

MachineLoad::Moment MachineLoad::now() {
    timespec own{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &own);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now().time_since_epoch();
    return {wall.count(), static_cast<double>(own.tv_sec) + 1e-9 * static_cast<double>(own.tv_nsec),
            busy_seconds()};
}

nlohmann::json MachineLoad::record() const {
    constexpr double shortest_told = 0.2;
    nlohmann::json load = {{"average", average_}};
    const Moment end = now();
    const double wall = end.wall - start_.wall;
    if (wall < shortest_told) return load;
    const double others = (end.all - start_.all) - (end.own - start_.own);
    load["other_cores"] = std::max(0.0, others / wall);
    return load;
}

}  // namespace caustics::experiments
