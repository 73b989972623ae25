#include "experiments/base/environment.h"

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <chrono>
#include <CLI/CLI.hpp>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "build_info.h"
#include "core/base/isa.h"
#include "core/base/parallel.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;

/// The text after `key` and a colon in a file of such lines; empty when there is none.
std::string field(const char* file, const std::string& key) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (line.compare(0, key.size(), key) != 0) continue;
        const std::size_t colon = line.find(':');
        if (colon == std::string::npos) continue;
        const std::size_t first = line.find_first_not_of(" \t", colon + 1);
        return first == std::string::npos ? std::string() : line.substr(first);
    }
    return {};
}

std::string first_line(const char* file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    return line;
}

std::uint64_t status_bytes(const std::string& key) {
    const std::string kibibytes = field("/proc/self/status", key);
    return kibibytes.empty() ? 0 : 1024 * std::stoull(kibibytes);
}

json libraries() {
    const int fmt_version = FMT_VERSION;
    return {{"embree", build_info::embree_version},
            {"tbb", build_info::tbb_version},
            {"eigen", build_info::eigen_version},
            {"openexr", build_info::openexr_version},
            {"libpng", build_info::libpng_version},
            {"openimageio", build_info::openimageio_version},
            {"nlohmann_json", build_info::nlohmann_json_version},
            {"fmt", fmt::format("{}.{}.{}", fmt_version / 10000, fmt_version / 100 % 100,
                                fmt_version % 100)},
            {"cli11", CLI11_VERSION}};
}

}  // namespace

std::string code_version() {
    return fmt::format("{} ({}{})", build_info::project_version, build_info::git_commit,
                       build_info::git_dirty ? "-dirty" : "");
}

std::string host_name() {
    char name[256] = {};
    gethostname(name, sizeof name - 1);
    return name;
}

std::string cpu_name() { return field("/proc/cpuinfo", "model name"); }

std::string utc_now() {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm utc{};
    gmtime_r(&now, &utc);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1,
                       utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec);
}

json environment() {
    std::vector<std::string> instruction_sets;
    for (const Isa isa : supported_isas()) instruction_sets.emplace_back(name(isa));
    return {{"version", std::string(build_info::project_version)},
            {"commit", std::string(build_info::git_commit)},
            {"dirty", build_info::git_dirty},
            {"compiler", fmt::format("{} {}", build_info::compiler, build_info::compiler_version)},
            {"flags", std::string(build_info::flags)},
            {"build_type", std::string(build_info::build_type)},
            {"host", host_name()},
            {"cpu", cpu_name()},
            {"instruction_sets", instruction_sets},
            {"threads_available", available_threads()},
            {"governor", first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor")},
            {"load", first_line("/proc/loadavg")},
            {"memory", field("/proc/meminfo", "MemTotal")},
            {"kernel", first_line("/proc/sys/kernel/osrelease")},
            {"libraries", libraries()},
            {"date", utc_now()}};
}

std::uint64_t resident_bytes() { return status_bytes("VmRSS"); }

std::uint64_t peak_resident_bytes() { return status_bytes("VmHWM"); }

void reset_peak_resident_bytes() {
    malloc_trim(0);
    // proc(5): 5 resets the peak resident set size to the current one.
    std::ofstream("/proc/self/clear_refs") << 5;
}

}  // namespace caustics::experiments
