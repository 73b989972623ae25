#pragma once

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

}  // namespace caustics::support
