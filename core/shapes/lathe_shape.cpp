#include "core/shapes/lathe_shape.h"

#include "core/exact_shapes/shape_keys.h"

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

Keys profile_keys() {
    return {{.key = "profile",
             .meaning = "The curve's points, each [r, z] or a profile point; r is from the axis z.",
             .unit = "m",
             .type = "list of points"},
            choice("interpolation", "Straight lines, or Catmull-Rom curves from crease to crease.",
                   "linear", "linear, catmullrom"),
            whole("segments", "Straight pieces between two points.", "", "1, or 8 with catmullrom",
                  "1 to 4096")};
}

Objects lathe_keys() {
    return {
        {"lathe",
         "A shape, a mesh: a profile turned round z. Its front is on the right of the profile's "
         "way, outside where that goes up.",
         joined(joined(turned_keys("Sectors round the axis; parts with as many fit together."),
                       profile_keys()),
                {yes_or_no("open", "The profile may end off the axis.", "false")})},
        {"profile point",
         "An element of profile, where the surface has an edge.",
         {{.key = "at", .meaning = "Its place.", .unit = "m", .type = "[r, z]"},
          yes_or_no("crease",
                    "Splits the normal. Without, it is smooth; a cone's tip, where straight lines "
                    "meet the axis aslant, is a crease in any case.",
                    "false")}}};
}

}  // namespace caustics::scene_file
