#pragma once

#include <string>

namespace caustics {

/// Looks at the attributes of an OpenEXR file before its library does, which makes room for what an attribute says to
/// be: 2 GB, in a file of 500 bytes. Throws std::runtime_error for one that goes on beyond the file, or whose type has
/// another length, for channels of no known type, for tiles of more than 2^22 pixels, and for more than 128 MB of values
/// that the file is too small for. What is no header at all is left to the library.
void require_attributes_within(const std::string& bytes);

}  // namespace caustics
