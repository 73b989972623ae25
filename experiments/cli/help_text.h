#pragma once

#include <string>
#include <vector>

namespace caustics::experiments {

/// What `help` describes: each method, and the kinds of files.
std::vector<std::string> help_topics();

/// What `help TOPIC` prints, in lines of at most 100 columns; the topics for an empty one. Empty for a
/// topic that is unknown.
std::string help_text(const std::string& topic);

}  // namespace caustics::experiments
