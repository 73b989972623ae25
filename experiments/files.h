#pragma once

#include <filesystem>
#include <string>

#include "core/whole_file.h"

namespace caustics {

/// What a file holds or a pipe brings until it ends; "-" is standard input. Waits for a pipe, and
/// throws Interrupted when asked to stop meanwhile. Throws InputError for folders and devices.
std::string read_input(const std::filesystem::path& file);

/// Tells a file from what it was: its number, its size, and when it was last written and last
/// changed in any way (which no program can choose). Empty when it is not there.
std::string file_stamp(const std::filesystem::path& file);

/// Writes to standard output; throws InputError when that fails (a full disk, a closed pipe).
void write_stdout(const std::string& text);

}  // namespace caustics
