#include "core/material/texture_reader.h"

#include <algorithm>

namespace caustics::scene_file {
namespace {

Eigen::Affine3f read_to_uv(const JsonNode& node) {
    const auto to_uv = node.find("to_uv");
    return to_uv ? Eigen::Affine3f(read_transform(*to_uv).cast<float>())
                 : Eigen::Affine3f::Identity();
}

Bitmap read_bitmap(const JsonNode& node, Assets& assets) {
    const auto raw = node.find("raw");
    const JsonNode name = node.at("filename");
    const std::filesystem::path file = read_file_name(name, assets);
    Bitmap bitmap = load_for(name, [&] {
        return load_bitmap(assets.pictures, file, raw && raw->as_bool(), assets.textures);
    });
    if (const auto filter = node.find("filter_type"))
        bitmap.filter = static_cast<Bitmap::Filter>(filter->as_choice({"bilinear", "nearest"}));
    if (const auto wrap = node.find("wrap_mode"))
        bitmap.wrap = static_cast<Bitmap::Wrap>(wrap->as_choice({"repeat", "mirror", "clamp"}));
    bitmap.to_uv = read_to_uv(node);
    node.finish();
    const auto bright = std::ranges::any_of(
        bitmap.texels, [](const Spectrum& texel) { return texel.maxCoeff() > 1; });
    if (bright) name.fail("the picture holds reflectances above 1");
    return bitmap;
}

Checkerboard read_checkerboard(const JsonNode& node) {
    Checkerboard board;
    board.color0 = read_colour(node, "color0", 0.4, 1);
    board.color1 = read_colour(node, "color1", 0.2, 1);
    board.to_uv = read_to_uv(node);
    node.finish();
    return board;
}

}  // namespace

Texture read_texture(const JsonNode& parent, const std::string& key, double fallback,
                     Assets& assets) {
    const auto node = parent.find(key);
    if (!node) return Spectrum(Spectrum::Constant(static_cast<float>(fallback)));
    if (!node->is_object()) {
        if (!node->is_number() && !(node->is_array() && node->as_array().size() == 3))
            node->fail(
                "must be a number, [r, g, b] or an object of the type rgb, bitmap or checkerboard");
        return read_colour(*node, 1);
    }
    const std::string type = read_type(*node, "texture", {"rgb", "bitmap", "checkerboard"},
                                       {"spectrum", "uniform", "mesh_attribute", "volume"});
    if (type == "bitmap") return read_bitmap(*node, assets);
    if (type == "checkerboard") return read_checkerboard(*node);
    return read_colour(*node, 1);
}

Objects texture_keys() {
    const KeyText to_uv{.key = "to_uv",
                        .meaning = "Moves the texture over the surface.",
                        .type = "transform",
                        .usual = "[]"};
    return {
        {"rgb",
         "A colour: a number or [r, g, b] may stand for it; linear sRGB.",
         {type_key(),
          {.key = "value", .meaning = "All channels, or each.", .type = "number or [r, g, b]"}}},
        {"bitmap",
         "A texture: a picture over the texture coordinates.",
         {type_key(), file("The picture, relative to the scene's file."),
          yes_or_no("raw", "Takes its numbers as they are, not as sRGB.", "false"),
          choice("filter_type", "Between texels.", "bilinear", "bilinear, nearest"),
          choice("wrap_mode", "Outside of the picture.", "repeat", "repeat, mirror, clamp"),
          to_uv}},
        {"checkerboard",
         "A texture: two colours by turns.",
         {type_key(), colour("color0", "Of the first cells.", "", "0.4", "0 to 1"),
          colour("color1", "Of the others.", "", "0.2", "0 to 1"), to_uv}}};
}

}  // namespace caustics::scene_file
