#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace caustics::support {

/// What a run of the program gave back.
struct ProgramResult {
    int exit_code = -1;  ///< -1: it did not end by itself
    std::string out;
    std::string err;
};

/// Runs causticbench with these arguments.
ProgramResult causticbench(const std::vector<std::string>& arguments);

/// Runs it, and sends SIGINT as soon as `file` exists.
ProgramResult interrupted_causticbench(const std::vector<std::string>& arguments,
                                       const std::filesystem::path& file);

}  // namespace caustics::support
