#pragma once

#include <filesystem>

#include "experiments/base/child_process.h"
#include "experiments/plan/sweep_plan.h"

namespace caustics::experiments {

/// Of a sweep file, read so that this process begins no thread and may run it.
inline SweepPlan plan_of(const std::filesystem::path& sweep) {
    return read_plan({sweep}, [](const auto& work) {
        return run_in_child([&](const ChildProcess::Tell&) { return work(); });
    });
}

}  // namespace caustics::experiments
