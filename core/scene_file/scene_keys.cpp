#include "core/scene_file/scene_keys.h"

#include <utility>

#include "core/material/ior.h"
#include "core/scene_file/shape_keys.h"

namespace caustics::scene_file {

namespace {

Objects files() {
    return {
        {"scene",
         "The file itself; beside these keys it holds a sensor, lights and shapes under names of "
         "your choice.",
         {choice("type", "Says that the file is a scene.", "scene", "scene"),
          whole("version", "Of the format.", "", "1", "1 to 1")}},
        {"$include",
         "An object that holds this key alone stands for the content of another file.",
         {{.key = "$include",
           .meaning = "The file, relative to the one that names it.",
           .type = "file"}}}};
}

Objects sensors() {
    const KeyText count =
        whole("sample_count", "Camera samples a pixel.", "samples", "4", "1 to 1048576");
    const KeyText split =
        whole("split_depth",
              "Specular events from the eye that follow reflection and refraction both, however "
              "faint: no specks on glass.",
              "events", "0", "0 to 6");
    return {
        {"perspective",
         "The sensor, a pinhole that looks along +z with +y up; holds a film and a sampler.",
         {type_key(), number("fov", "Field of view.", "degrees", "50", "0.000001 to 179.9999"),
          choice("fov_axis", "Which extent of the film fov is for.", "x",
                 "x, y, diagonal, smaller, larger"),
          transform("Place and view: rotations, translations and one scale.")}},
        {"hdrfilm",
         "The film, in a sensor; may hold a reconstruction filter.",
         {type_key(), whole("width", "Of the picture.", "pixels", "768", "1 to 65536"),
          whole("height", "Of the picture.", "pixels", "576", "1 to 65536")}},
        {"box", "The reconstruction filter, in a film.", {type_key()}},
        {"independent", "A sampler, in a sensor: random samples.", {type_key(), count, split}},
        {"stratified",
         "A sampler, in a sensor: one sample in each cell of a square grid.",
         {type_key(),
          whole("sample_count", "Camera samples a pixel, a square number.", "samples", "4",
                "1 to 1048576"),
          yes_or_no("jitter", "Samples lie at random in their cells, not at the middle.", "true"),
          split}},
        {"adaptive",
         "A sampler, in a sensor: more samples where those of a pixel scatter.",
         {type_key(),
          whole("sample_count", "First samples of a pixel.", "samples", "4", "2 to 1048576"),
          whole("max_sample_count", "Most samples of a pixel.", "samples", "32 times sample_count",
                "sample_count to 1048576"),
          number("max_error", "Allowed standard error of a pixel over its brightness.", "", "0.05",
                 "above 0"),
          split}}};
}

Objects lights() {
    return {
        {"point",
         "A light, in the scene.",
         {type_key(), vector("position", "Where it is.", "[0, 0, 0]"),
          transform("Where it is, in place of position."),
          colour("intensity", "Power sent into a direction.", "W/sr", "1", "0 to 1e+30")}},
        {"spot",
         "A light, in the scene: from a point, about an axis.",
         {type_key(), transform("Where it is, and its axis: +z."),
          colour("intensity", "Power sent along the axis.", "W/sr", "1", "0 to 1e+30"),
          number("cutoff_angle", "From the axis to where no light goes.", "degrees", "20",
                 "0.001 to 179"),
          number("beam_width", "From the axis to where the light begins to fall, linearly.",
                 "degrees", "0.75 times cutoff_angle", "0 to cutoff_angle")}},
        {"directional",
         "A light, in the scene: parallel rays from far away.",
         {type_key(),
          {.key = "direction",
           .meaning = "Where the light goes, of any length.",
           .type = "[x, y, z]",
           .usual = "[0, 0, 1]"},
          transform("The light goes along its +z, in place of direction."),
          colour("irradiance", "On a surface across the light.", "W/m^2", "1", "0 to 1e+30")}},
        {"constant",
         "A light, in the scene, once: the same from all around, from infinitely far away.",
         {type_key(), colour("radiance", "Of every direction.", "W/(m^2 sr)", "1", "0 to 1e+30")}},
        {"ambient",
         "A light, in the scene: on every receiver, times its albedo, without shadows; no "
         "caustics.",
         {type_key(), colour("radiance", "From all around.", "W/(m^2 sr)", "1", "0 to 1e+30")}},
        {"area",
         "A light, in a shape that shines from its front side.",
         {type_key(), colour("radiance", "Of the surface.", "W/(m^2 sr)", "1", "0 to 1e+30")}}};
}

Objects bsdfs() {
    const KeyText reflected = colour(
        "specular_reflectance", "Share of the reflected light that is kept.", "", "1", "0 to 1");
    const auto ior = [](const std::string& key, const std::string& meaning,
                        const std::string& usual) {
        return KeyText{.key = key,
                       .meaning = meaning,
                       .type = "number, Mitsuba's name or law",
                       .usual = usual,
                       .choices = "0.1 to 10"};
    };
    return {
        {"diffuse",
         "A bsdf, in a shape: Lambert's law; the default.",
         {type_key(), texture("reflectance", "Share of the light that is scattered.", "0.5")}},
        {"schlick",
         "A bsdf, in a shape: Schlick's glossy model.",
         {type_key(),
          texture("reflectance", "Factor of the model.", "0.5"),
          {.key = "alpha",
           .meaning = "Roughness: 1 is broad, towards 0 a mirror.",
           .source = "[J96 (5)]",
           .type = "number",
           .usual = "1",
           .choices = "0.000001 to 1"}}},
        {"phong",
         "A bsdf, in a shape: Lambert's law and Phong's lobe about the mirror direction.",
         {type_key(),
          texture("diffuse_reflectance", "Share of the light that is scattered evenly.", "0.5"),
          texture("specular_reflectance",
                  "Share that goes to the lobe; the two together at most 1.", "0.2"),
          number("exponent", "How narrow the lobe is.", "", "30", "0 to 1000000"),
          choice("model", "Energy is kept, or the law of 1975 as it was.", "normalised",
                 "normalised, classic")}},
        {"dielectric",
         "A bsdf, in a shape: smooth glass or water; the shape is a caster.",
         {type_key(), ior("int_ior", "Refractive index behind the surface.", "bk7"),
          ior("ext_ior", "Refractive index in front of it.", "air"),
          colour("absorption", "Of the inside.", "1/m", "0", "0 to 1e+30"),
          colour("ext_absorption", "Of the outside.", "1/m", "0", "0 to 1e+30"), reflected,
          colour("specular_transmittance", "Share of the refracted light that is kept.", "", "1",
                 "0 to 1")}},
        {"conductor",
         "A bsdf, in a shape: a mirror; the shape is a caster.",
         {type_key(), choice("material", "The perfect mirror.", "none", "none"), reflected}},
        {"blendbsdf",
         "A bsdf, in a shape: one of diffuse, schlick, phong and a conductor, which it holds; the "
         "shape is a receiver and a caster.",
         {type_key(), number("weight",
                             "Share of the second of the two, by the names of their keys; the "
                             "first has the rest.",
                             "", "0.5", "0 to 1")}},
        {"twosided",
         "A bsdf, in a shape: the diffuse, schlick, phong, conductor or blendbsdf that it holds, "
         "on both sides.",
         {type_key()}}};
}

Objects laws() {
    const auto law = [](const std::string& key, const std::string& meaning, const std::string& type,
                        const std::string& unit = {}, const std::string& range = {}) {
        return KeyText{
            .key = key, .meaning = meaning, .unit = unit, .type = type, .choices = range};
    };
    KeyText material = law("material", "A glass by its name, in place of B and C.", "word");
    material.usual = "none";
    material.choices = named_glass_list();
    return {
        {"cauchy",
         "A law of dispersion, for an index of refraction: n = A + B / l^2, l the wavelength in "
         "um.",
         {type_key(), law("A", "n of very long waves.", "number", "", "-1000000 to 1000000"),
          law("B", "How it grows to shorter ones.", "number", "um^2", "-1000000 to 1000000")}},
        {"sellmeier",
         "A law of dispersion: n^2 = 1 + sum of B l^2 / (l^2 - C), as glass catalogues give it.",
         {type_key(), material, law("B", "One for each term.", "list of numbers"),
          law("C", "As many.", "list of numbers", "um^2")}},
        {"abbe",
         "A law of dispersion: Cauchy's through n_d, with Abbe's number.",
         {type_key(), law("n_d", "n at 587.6 nm.", "number", "", "1 to 10"),
          law("V_d", "(n_d - 1) / (n_F - n_C): small where colours part widely.", "number", "",
              "above 0, to 1000000")}}};
}

Objects textures() {
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

Objects transforms() {
    const auto part = [](const std::string& key, const std::string& meaning,
                         const std::string& type, const std::string& unit = {}) {
        return KeyText{.key = key, .meaning = meaning, .unit = unit, .type = type};
    };
    KeyText translate = part("translate", "Moves.", "[x, y, z]", "m");
    KeyText rotate = part("rotate", "Turns; see below.", "object");
    KeyText scale = part("scale", "Stretches.", "number or [x, y, z]");
    KeyText look_at = part("look_at", "Turns +z from one point to another; see below.", "object");
    for (KeyText* each : {&translate, &rotate, &scale, &look_at}) each->usual = "none";
    return {{"transform",
             "A list of such objects of one key each, applied in their order, or 16 numbers row by "
             "row.",
             {translate, rotate, scale, look_at}},
            {"rotate",
             "In a transform.",
             {part("axis", "Of any length.", "[x, y, z]"),
              part("angle", "Right-handed.", "number", "degrees")}},
            {"look_at",
             "In a transform.",
             {part("origin", "Where the view starts.", "[x, y, z]", "m"),
              part("target", "What it goes to.", "[x, y, z]", "m"),
              part("up", "What is up in it.", "[x, y, z]")}}};
}

}  // namespace

const std::vector<ObjectText>& scene_keys() {
    static const Objects all = [] {
        Objects made;
        for (Objects family : {files(), sensors(), lights(), shape_keys(), bsdfs(), laws(),
                               textures(), transforms()})
            for (ObjectText& object : family) made.push_back(std::move(object));
        return made;
    }();
    return all;
}

}  // namespace caustics::scene_file
