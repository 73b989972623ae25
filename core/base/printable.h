#pragma once

#include <string>
#include <string_view>

namespace caustics {

/// Text for a message: one line of UTF-8 that a terminal shows as it is. Line ends and tabs become
/// spaces, what else cannot be printed (control characters, bytes that are no UTF-8) becomes '?'.
/// The middle is left out of words of more than 500 bytes and of lines of more than 2,000.
std::string one_line(std::string_view text);

/// Whether all of it is UTF-8 (RFC 3629: no surrogates, nothing longer than need be).
bool is_utf8(std::string_view text);

}  // namespace caustics
