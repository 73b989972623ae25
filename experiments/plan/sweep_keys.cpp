#include "experiments/plan/sweep_keys.h"

#include <fmt/format.h>

#include "core/base/parallel.h"

namespace caustics::experiments {

namespace {

KeyText whole(const std::string& key, const std::string& meaning, const std::string& usual,
              const std::string& range) {
    return {
        .key = key, .meaning = meaning, .type = "whole number", .usual = usual, .choices = range};
}

KeyText list_key(const std::string& key, const std::string& meaning, const std::string& of,
                 const std::string& usual = {}) {
    return {.key = key, .meaning = meaning, .type = "list of " + of, .usual = usual};
}

ObjectText sweep_object() {
    return {
        "sweep",
        "The file itself: one trial for each combination of the lists' values.",
        {whole("version", "Of the format.", "", "1 to 1"),
         list_key("scenes", "The scenes, relative to the sweep file.", "files"),
         {.key = "set",
          .meaning = "Values of the scenes: axes under names that become columns.",
          .type = "object",
          .usual = "{}"},
         list_key("methods", "What makes the pictures.", "methods"),
         list_key("indirect", "What makes the light between diffuse surfaces.", "methods", "none"),
         list_key("seeds", "Of all random numbers, each from 0 to 1e15.", "whole numbers", "[1]"),
         whole("repeats", "The same picture again, for its times.", "1", "1 to 1000000000"),
         whole("spp", "Camera samples a pixel.", "16", "1 to 1000000"),
         whole("threads", "Of a trial.", "1", fmt::format("1 to {}", most_threads)),
         {.key = "reference",
          .meaning = "What errors are measured against; without one there are none.",
          .type = "object",
          .usual = "none"}}};
}

KeyText method_key() {
    return {.key = "method", .meaning = "Its name; help lists the methods.", .type = "word"};
}

ObjectText axis() {
    return {"axis",
            "An object in set: its name has small letters, digits and underscores.",
            {{.key = "pointer",
              .meaning = "JSON pointer into the scene, as of --set: /water/resolution.",
              .type = "text"},
             list_key("values", "What stands there, one after another.", "any values")}};
}

ObjectText method() {
    return {
        "method",
        "An element of methods, or of indirect: there one of its layer, or none.",
        {method_key(),
         {.key = "param",
          .meaning = "Its parameters, each a value or a list of values; help METHOD lists them.",
          .type = "object",
          .usual = "{}"}}};
}

ObjectText reference() {
    return {"reference",
            "The object of that key.",
            {method_key(),
             {.key = "param",
              .meaning = "Its parameters, each one value.",
              .type = "object",
              .usual = "{}"},
             {.key = "indirect",
              .meaning = "The method of its indirect light, with param as above.",
              .type = "object",
              .usual = "none"},
             whole("spp", "Camera samples a pixel.", "64, or the sweep's where that is more",
                   "1 to 1000000"),
             whole("seed", "Of its random numbers.", "1", "0 to 1000000000")}};
}

}  // namespace

const std::vector<ObjectText>& sweep_keys() {
    static const std::vector<ObjectText> all = {sweep_object(), axis(), method(), reference()};
    return all;
}

}  // namespace caustics::experiments
