#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace caustics::experiments {

/// "1.2.3 (0123abc)", with "-dirty" after the commit of a changed tree.
std::string code_version();

std::string host_name();
/// Model of the processor; empty where the system does not tell.
std::string cpu_name();
/// "2026-11-21T17:04:32Z".
std::string utc_now();

/// Where the program runs and how it was built: commit and dirty flag, compiler and flags, host,
/// CPU, governor, load, library versions, date (UTC).
nlohmann::json environment();

/// Bytes of the process in memory now.
std::uint64_t resident_bytes();
/// Most bytes since reset_peak_resident_bytes(), or since the start where the kernel does not
/// allow the reset.
std::uint64_t peak_resident_bytes();
/// Returns freed memory to the system and begins a new peak.
void reset_peak_resident_bytes();

}  // namespace caustics::experiments
