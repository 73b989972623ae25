#pragma once

#include <filesystem>

namespace caustics {

/// Waits until a file's content, or the names in a folder, are on the disk: a crash of the machine
/// keeps what was brought there, and may drop, reorder or cut short what was not. Throws InputError
/// naming the place and the system's reason.
void bring_to_disk(const std::filesystem::path& place);

/// Makes the folder and those above it that are missing, and brings their names to the disk. Throws
/// std::filesystem::filesystem_error, or InputError as above.
void make_folders(const std::filesystem::path& folder);

/// The same of an open file or folder; `place` is for the message.
void bring_to_disk(int descriptor, const std::filesystem::path& place);

/// The folder that a file or folder is named in.
std::filesystem::path folder_above(const std::filesystem::path& place);

}  // namespace caustics
