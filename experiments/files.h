#pragma once

#include <filesystem>
#include <string>

namespace caustics {

/// Writes a text file to a temporary name beside it and renames it, so that the file is whole or
/// absent. Throws InputError when it cannot be written.
void write_whole_file(const std::filesystem::path& file, const std::string& text);

/// The content of a file. Throws InputError when it cannot be read.
std::string read_whole_file(const std::filesystem::path& file);

/// Writes to standard output; throws InputError when that fails (a full disk, a closed pipe).
void write_stdout(const std::string& text);

}  // namespace caustics
