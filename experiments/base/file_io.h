#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/atomic_file.h"

namespace caustics::experiments {

/// What a file holds or a pipe brings until it ends; "-" is standard input. Waits for a pipe, and
/// throws Interrupted when asked to stop meanwhile. Throws InputError for folders and devices.
std::string read_input(const std::filesystem::path& file);

/// Tells a file from what it was: its number, its size, and when it was last written and last
/// changed in any way (which no program can choose). Empty when it is not there.
std::string file_stamp(const std::filesystem::path& file);

/// What the file system refused, in one line: the file or folder, and the reason.
std::string reason_of(const std::filesystem::filesystem_error& error);

/// Takes the places of standard streams that are closed, before the first file that is opened gets
/// one of them and is written into by messages; writing to such a stream still fails.
void hold_standard_streams();

/// Writes to standard error, all or as much as there is room for: a message that cannot be written
/// is no reason to stop.
void write_stderr(std::string_view text);

/// Writes to standard output; throws InputError when that fails (a full disk, a closed pipe).
void write_stdout(const std::string& text);

}  // namespace caustics::experiments
