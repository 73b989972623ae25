#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace caustics::experiments {

/// JSON that anybody may have written: a folder of results, a picture's attribute, the command line. What
/// compares and prints values calls itself level by level, so that text nested more than 64 levels deep,
/// which nothing of ours is, would end the stack. Throws nlohmann::json::exception where it is no JSON, and
/// InputError where it is too deep.
nlohmann::json parse_bounded(const std::string& text);

/// The same; a discarded value (is_discarded()) in place of errors.
nlohmann::json parse_bounded_or_discard(const std::string& text);

}  // namespace caustics::experiments
