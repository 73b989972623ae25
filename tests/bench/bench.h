#pragma once

#include "core/base/isa.h"

namespace caustics::bench {

struct BenchOptions {
    Isa isa = widest_isa();  ///< of the program's own kernels; peers are compiled for this machine
    bool quick = false;      ///< fewer cases and queries, for a first look
};

/// Every benchmark program defines this; called once, before any benchmark runs.
void register_benchmarks(const BenchOptions& options);

}  // namespace caustics::bench
