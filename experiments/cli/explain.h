#pragma once

#include <filesystem>
#include <string>

namespace caustics::experiments {

/// The command that makes a trial's picture again, one line for a shell, between remarks, lines that
/// begin with #. `trial`: its id, the beginning of one, or the hash at its end. Every word is one for
/// the shell, whatever a foreign folder says. Throws InputError where there is no such trial, it has
/// not run, or its record does not say what a run needs.
std::string explain(const std::filesystem::path& folder, const std::string& trial);

}  // namespace caustics::experiments
