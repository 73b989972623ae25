#pragma once

#include <functional>

namespace caustics::experiments {

/// Reads a command line, the program's name first, and returns what it asks for; nothing of that has run.
/// It returns the exit code (0 done, 1 some trials failed). Throws InputError naming verbs and options for
/// words that are not understood.
std::function<int()> parse_command_line(int argc, const char* const* argv);

}  // namespace caustics::experiments
