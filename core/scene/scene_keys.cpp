#include "core/scene/scene_keys.h"

#include <utility>

#include "core/lights/light.h"
#include "core/material/bsdf_reader.h"
#include "core/material/ior_reader.h"
#include "core/material/texture_reader.h"
#include "core/scene/shape_reader.h"

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
              "events", "2", "0 to 6");
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
         "A sampler, in a sensor: more samples where those of a pixel scatter. Light finer than "
         "pixels "
         "that its first samples miss is lost (stripes that are lit to 3 %: two thirds of it by 4 "
         "samples, none by 16).",
         {type_key(),
          whole("sample_count", "First samples of a pixel.", "samples", "4", "2 to 1048576"),
          whole("max_sample_count", "Most samples of a pixel.", "samples", "32 times sample_count",
                "sample_count to 1048576"),
          number("max_error", "Allowed standard error of a pixel over its brightness.", "", "0.05",
                 "above 0 to 1e+30"),
          split}}};
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
              number("angle", "Right-handed.", "degrees", "", "-1e+06 to 1e+06")}},
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
        for (Objects family : {files(), sensors(), light_keys(), shape_keys(), bsdf_keys(),
                               ior_keys(), texture_keys(), transforms()})
            for (ObjectText& object : family) made.push_back(std::move(object));
        return made;
    }();
    return all;
}

}  // namespace caustics::scene_file
