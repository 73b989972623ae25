#include "core/render/film.h"

#include <algorithm>
#include "tests/cruel/parts.h"

namespace caustics::cruel {

Json Parts::colour(double low, double high) {
    if (dice_.chance(0.5)) return dice_.number(low, high);
    const Json rgb = {dice_.number(low, high), dice_.number(low, high), dice_.number(low, high)};
    if (dice_.chance(0.7)) return rgb;
    return {{"type", "rgb"}, {"value", rgb}};
}

namespace {

Json turned_texture(Dice& dice) {
    const Json turn = {{"axis", {0, 0, 1}}, {"angle", dice.number(0, 90)}};
    return Json::array({Json::object({{"rotate", turn}}), scale_by(dice.number(0.5, 4))});
}

}  // namespace

Json Parts::texture() {
    if (dice_.chance(0.5)) {
        Json checkers = {{"type", "checkerboard"}, {"to_uv", turned_texture(dice_)}};
        if (dice_.chance(0.5)) checkers["color0"] = colour(0, 1);
        if (dice_.chance(0.5)) checkers["color1"] = colour(0, 1);
        return checkers;
    }
    const int width = dice_.whole(1, 4), height = dice_.whole(1, 4);
    std::vector<unsigned char> pixels(static_cast<std::size_t>(3 * width * height));
    for (unsigned char& value : pixels) value = static_cast<unsigned char>(dice_.whole(0, 255));
    const auto file = new_file(".png");
    write_png(width, height, pixels, file);
    Json picture = {{"type", "bitmap"}, {"filename", file.filename().string()}};
    if (dice_.chance(0.3)) picture["raw"] = dice_.chance(0.5);
    if (dice_.chance(0.5)) picture["filter_type"] = dice_.pick({"bilinear", "nearest"});
    if (dice_.chance(0.5)) picture["wrap_mode"] = dice_.pick({"repeat", "mirror", "clamp"});
    if (dice_.chance(0.5)) picture["to_uv"] = turned_texture(dice_);
    return picture;
}

Json Parts::receiver_bsdf() {
    Json bsdf;
    const int kind = dice_.whole(0, measured() ? 4 : 9);
    if (kind <= 5) {
        bsdf = {{"type", "diffuse"}};
        if (dice_.chance(0.8)) bsdf["reflectance"] = dice_.chance(0.7) ? colour(0, 1) : texture();
    } else if (kind <= 7) {
        bsdf = {{"type", "schlick"},
                {"alpha", dice_.pick({1e-6, 0.01, 0.1, 0.5, 1.0})},
                {"reflectance", colour(0, 1)}};
    } else {
        bsdf = {{"type", "phong"},
                {"exponent", dice_.pick({0.0, 1.0, 30.0, 1e4})},
                {"diffuse_reflectance", colour(0, 0.5)},
                {"specular_reflectance", colour(0, 0.5)}};
        if (dice_.chance(0.3)) bsdf["model"] = dice_.pick({"normalised", "classic"});
    }
    // Which of the two is the first is said by their names.
    if (dice_.chance(0.15))
        bsdf = {{"type", "blendbsdf"},
                {"weight", dice_.number(0, 1)},
                {dice_.chance(0.5) ? "a" : "z", bsdf},
                {"m", {{"type", "conductor"}, {"specular_reflectance", colour(0, 1)}}}};
    if (dice_.chance(0.3)) bsdf = {{"type", "twosided"}, {"inner", bsdf}};
    return bsdf;
}

Json Parts::mirror_bsdf() {
    Json bsdf = {{"type", "conductor"}};
    if (dice_.chance(0.3)) bsdf["material"] = "none";
    if (dice_.chance(0.6)) bsdf["specular_reflectance"] = colour(0.2, 1);
    if (dice_.chance(0.5)) bsdf = {{"type", "twosided"}, {"inner", bsdf}};
    return bsdf;
}

Json Parts::ior(double low, double high) {
    const double n = dice_.number(low, high);
    switch (dice_.whole(0, 9)) {
        case 0: return dice_.pick({"water", "bk7", "diamond", "air", "vacuum", "ethanol"});
        case 1: return {{"type", "cauchy"}, {"A", n}, {"B", dice_.number(0.002, 0.02)}};
        case 2:
            return {{"type", "sellmeier"},
                    {"material", dice_.pick({"bk7", "sf10", "water", "f2"})}};
        case 3:
            return {{"type", "sellmeier"},
                    {"B", {dice_.number(0.5, 1.5), 0.2}},
                    {"C", {0.01, dice_.number(0.01, 0.03)}}};
        case 4:
            return {{"type", "abbe"}, {"n_d", std::max(1.01, n)}, {"V_d", dice_.number(20, 80)}};
        default: return n;
    }
}

Json Parts::glass_bsdf(const Json& outer) {
    Json bsdf = {{"type", "dielectric"}};
    bsdf["int_ior"] = ior(1.2, measured() ? 2.42 : 2);
    bsdf["ext_ior"] = outer.contains("int_ior") ? outer["int_ior"] : Json(1);
    if (dice_.chance(0.3)) bsdf["absorption"] = colour(0, 2);
    if (outer.contains("absorption")) bsdf["ext_absorption"] = outer["absorption"];
    if (dice_.chance(0.2)) bsdf["specular_reflectance"] = colour(0.2, 1);
    if (dice_.chance(0.2)) bsdf["specular_transmittance"] = colour(0.2, 1);
    if (measured()) return bsdf;
    if (dice_.chance(0.1)) std::swap(bsdf["int_ior"], bsdf["ext_ior"]);
    if (dice_.chance(0.1)) bsdf.erase("ext_ior");
    if (dice_.chance(0.1)) bsdf.erase("int_ior");
    if (dice_.chance(0.1)) bsdf["ext_absorption"] = colour(0, 1);
    return bsdf;
}

}  // namespace caustics::cruel
