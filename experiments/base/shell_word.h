#pragma once

#include <filesystem>
#include <string>

namespace caustics::experiments {

/// The text as one word for a shell (POSIX), on one line whatever is in it. Line breaks at the end of
/// a text are lost: a shell keeps none of what a command prints.
std::string shell_word(const std::string& text);
/// A file's name as such a word, which no program takes for an option.
std::string shell_path(const std::filesystem::path& file);

}  // namespace caustics::experiments
