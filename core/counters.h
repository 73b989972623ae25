#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "core/light_ledger.h"

namespace caustics {

/// Counts by name, summed over threads in any order (they are whole numbers).
using Counters = std::map<std::string, std::uint64_t>;

/// Adds counters under names of their own, which begin with the prefix.
inline void add_under(const std::string& prefix, const Counters& counted, Counters& to) {
    for (const auto& [name, count] : counted) to[prefix + name] += count;
}

/// What a built method holds.
struct BuildReport {
    std::uint64_t bytes = 0;  ///< of the built data
    Counters counters;
    /// Parameters the method chose by itself, by name (a maximum radius, say).
    std::map<std::string, double> resolved;
    std::optional<LightLedger> light = {};  ///< of methods that know it
};

}  // namespace caustics
