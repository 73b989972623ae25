#include "core/exact_shapes/shape_keys.h"

namespace caustics::scene_file {

Keys mesh_keys() {
    return {type_key(), transform("Places the shape in the world."),
            yes_or_no("flip_normals", "Turns the front side over.", "false"),
            yes_or_no("face_normals", "Shades a mesh flat, triangle by triangle.", "false")};
}

Keys parametric_keys(const std::string& least) {
    return joined(mesh_keys(), {whole("resolution",
                                      "Cells along each parameter of a mesh that replaces the "
                                      "shape in every method.",
                                      "cells", "none", least + " to 4096")});
}

Keys grid_keys() {
    Keys keys = parametric_keys("1");
    keys.back().type = "whole number or [nx, ny]";
    return keys;
}

Keys turned_keys(const std::string& resolution_of) {
    return joined(mesh_keys(), {whole("resolution", resolution_of, "sectors", "64", "3 to 4096")});
}

KeyText radius_key() { return number("radius", "Of the shape.", "m", "1", "above 0 to 1e+30"); }

double read_radius(const JsonNode& node) {
    const auto radius = node.find("radius");
    if (!radius) return 1;
    const double value = radius->as_number_in(0, unlimited);
    if (value == 0) radius->fail("must be above 0");
    return value;
}

}  // namespace caustics::scene_file
