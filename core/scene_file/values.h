#pragma once

#include <new>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/math/spectrum.h"
#include "core/math/vec.h"
#include "core/picture/picture_reader.h"
#include "core/scene_file/json_reader.h"

namespace caustics::scene_file {

/// The files that a scene file refers to, and how its pictures are read.
struct Assets {
    /// Absolute file -> name as written.
    std::vector<std::pair<std::filesystem::path, std::string>> files = {};
    std::set<std::pair<std::filesystem::path, std::string>> noted = {};  ///< `files`, to be found
    PictureDepth textures = PictureDepth::whole;
    PictureReader pictures = PictureReader();
};

/// The range of numbers that have no range of their own: their squares fit a double, and they a float.
inline constexpr double unlimited = 1e30;

/// Two or three numbers, none beyond it.
Vec2d read_pair(const JsonNode& node);
Vec3d read_vector(const JsonNode& node);
/// Fails at the node unless all points are within `farthest_coordinate`.
void require_near(const JsonNode& node, const std::vector<Vec3d>& points);
/// A number, [r, g, b], or {"type": "rgb", "value": number or [r, g, b]}; 0 <= value <= `most`.
Spectrum read_colour(const JsonNode& node, double most);
Spectrum read_colour(const JsonNode& parent, const std::string& key, double fallback, double most);
/// A 4x4 row-major matrix or a list of operations, applied in their order. Never singular.
Transform read_transform(const JsonNode& node);
/// The file named by the string node, relative to the file the node was written in; noted.
std::filesystem::path read_file_name(const JsonNode& node, Assets& assets);
/// Calls a maker of something large, and names the node that asked for it where memory ends.
template <class Make>
auto make_for(const JsonNode& node, const Make& make) {
    try {
        return make();
    } catch (const std::bad_alloc&) {
        node.fail("does not fit into memory");
    }
}
/// Calls a loader of files that knows nothing of the scene, and names the node that asked for the
/// file in what it throws.
template <class Load>
auto load_for(const JsonNode& node, const Load& load) {
    try {
        return make_for(node, load);
    } catch (const InputError& e) {
        node.fail(e.what());
    }
}
/// The object's `type`, refused with the list of what is known unless it is in `known`; names of
/// `later` are said to be not supported yet.
std::string read_type(const JsonNode& node, const std::string& family,
                      const std::vector<std::string>& known,
                      const std::vector<std::string>& later = {});

}  // namespace caustics::scene_file
