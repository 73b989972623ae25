#pragma once

#include <string>
#include <vector>

namespace caustics::experiments {

/// What `help` describes: each method, and the kinds of files.
std::vector<std::string> help_topics();

/// The text that `help TOPIC` prints, in lines of at most 100 columns. An empty topic gives the list of topics, and
/// an unknown one an empty text.
std::string help_text(const std::string& topic);

}  // namespace caustics::experiments
