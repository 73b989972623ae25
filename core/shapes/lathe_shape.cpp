#include "core/shapes/lathe_shape.h"

namespace caustics::scene_file {
namespace {

ProfilePoint read_point(const JsonNode& node) {
    if (!node.is_object()) return {read_pair(node)};
    ProfilePoint point{read_pair(node.at("at"))};
    if (const auto crease = node.find("crease")) point.crease = crease->as_bool();
    node.finish();
    return point;
}

}  // namespace

LatheProfile read_profile(const JsonNode& node) {
    LatheProfile profile;
    for (const JsonNode& point : node.at("profile").as_array())
        profile.points.push_back(read_point(point));
    if (const auto interpolation = node.find("interpolation"))
        profile.catmull_rom = interpolation->as_choice({"linear", "catmullrom"}) == 1;
    profile.segments = profile.catmull_rom ? 8 : 1;
    if (const auto segments = node.find("segments"))
        profile.segments = static_cast<int>(segments->as_integer_in(1, 4096));
    return profile;
}

TriangleMesh read_lathe(const JsonNode& node, int sectors) {
    LatheProfile profile = read_profile(node);
    if (const auto open = node.find("open")) profile.open = open->as_bool();
    return load_for(node.at("profile"), [&] { return tessellate_lathe(profile, sectors); });
}

}  // namespace caustics::scene_file
