#include "experiments/export/exported_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/geometry/tessellate.h"

namespace caustics::experiments {

void refuse_export(const ExportSettings& settings, const std::string& object,
                   const std::string& reason) {
    throw UnsupportedScene(fmt::format("{}: {}: {}", settings.scene_file, object, reason));
}

std::string with_setting(const ExportRefusal& refusal, const std::string& place) {
    if (refusal.setting.empty()) return refusal.reason;
    const bool quoted = refusal.setting.find('{') != std::string::npos;
    return fmt::format("{}, such as --set {}{}{}{}", refusal.reason, quoted ? "'" : "", place,
                       refusal.setting, quoted ? "'" : "");
}

TriangleMesh baked_mesh(const Shape& shape, const ExportSettings& settings,
                        std::vector<std::string>& notes) {
    if (shape.primitive != Primitive::mesh)
        notes.push_back(fmt::format(
            "/{}: the exact shape is written as a mesh of resolution {}, which other methods here "
            "see only with --set /{}/resolution={}",
            shape.name, settings.mesh_resolution, shape.name, settings.mesh_resolution));
    return tessellate_shape(shape, settings.mesh_resolution);
}

std::string plain_name(const std::string& name, std::size_t number) {
    constexpr std::size_t longest = 64;
    std::string plain = name.substr(0, longest);
    std::ranges::replace_if(
        plain,
        [](char c) {
            const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
            return !letter && !(c >= '0' && c <= '9') && c != '_' && c != '-';
        },
        '-');
    return fmt::format("shape{}-{}", number, plain);
}

}  // namespace caustics::experiments
