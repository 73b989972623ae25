#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/picture/picture_source.h"
#include "core/scene/scene.h"

namespace caustics {

/// A scene file read and resolved.
struct SceneFile {
    SceneDesc desc;
    std::string canonical;  ///< JSON after `$include` and `--set`, sorted keys
    /// Meshes and pictures it refers to: name as written -> hash of the file's bytes.
    std::vector<std::pair<std::string, std::string>> assets;
    std::vector<std::filesystem::path> files;  ///< all that was read: it, what it includes, assets
    /// Hash of canonical text and assets: names the scene in records and reference keys.
    std::string hash;
};

/// `--set`: JSON pointer and value (JSON, or else a string).
using Overrides = std::vector<std::pair<std::string, std::string>>;

/// Reads a scene file (contract: JSON with Mitsuba 3's words). Throws InputError with file, JSON
/// pointer and alternatives for anything unknown, missing, of the wrong type or out of range. Where only the headers of
/// textures are read, their colours are unknown: such a scene is described, not rendered.
SceneFile load_scene(const std::filesystem::path& file, const Overrides& overrides = {},
                     PictureDepth textures = PictureDepth::whole);

}  // namespace caustics
