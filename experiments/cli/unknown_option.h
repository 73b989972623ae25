#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace caustics::experiments {

/// Throws InputError for the option `words[place]`, which the verb does not know. The message names the parameter of
/// that name, if a method has one, or else the nearest options and parameters, and all options.
[[noreturn]] void refuse_option(const CLI::App& verb, const std::vector<std::string>& words,
                                std::size_t place);

}  // namespace caustics::experiments
