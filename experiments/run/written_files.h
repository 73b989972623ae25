#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/run/render_and_score.h"

namespace caustics::experiments {

/// Throws InputError where one file is named for two results, of which the later would take the place of the earlier: those of
/// `-o`, and files that parameters of the request's methods name; or where a result would take the place of a file that is
/// read: `read`, and those that parameters name.
void require_files_apart(const std::vector<std::string>& outputs, const RunRequest& request,
                         const std::vector<std::filesystem::path>& read);

}  // namespace caustics::experiments
