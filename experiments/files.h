#pragma once

#include <filesystem>
#include <string>

#include "core/whole_file.h"

namespace caustics {

/// The content of a file. Throws InputError when it cannot be read.
std::string read_whole_file(const std::filesystem::path& file);

/// Writes to standard output; throws InputError when that fails (a full disk, a closed pipe).
void write_stdout(const std::string& text);

}  // namespace caustics
