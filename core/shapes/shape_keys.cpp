#include "core/shapes/shape_keys.h"

#include <utility>

namespace caustics::scene_file {

namespace {

// Without a resolution.
Keys mesh_keys() {
    return {type_key(), transform("Places the shape in the world."),
            yes_or_no("flip_normals", "Turns the front side over.", "false"),
            yes_or_no("face_normals", "Shades a mesh flat, triangle by triangle.", "false")};
}

Keys parametric_keys(const std::string& least) {
    return joined(mesh_keys(), {whole("resolution",
                                      "Cells along each parameter of a mesh that stands for the "
                                      "shape for everybody.",
                                      "cells", "none", least + " to 4096")});
}

// Whose cells along x and y may differ.
Keys grid_keys() {
    Keys keys = parametric_keys("1");
    keys.back().type = "whole number or [nx, ny]";
    return keys;
}

Keys turned_keys(const std::string& resolution_of) {
    return joined(mesh_keys(), {whole("resolution", resolution_of, "sectors", "64", "3 to 4096")});
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

KeyText half_size() {
    return {.key = "half_size",
            .meaning = "Half the rectangle's extent in x and y.",
            .unit = "m",
            .type = "[x, y]",
            .usual = "[1, 1]"};
}

Objects heightfields() {
    KeyText picture = file(
        "Heights by a picture of one channel, 16-bit PNG or EXR, in place of waves; its pixels are "
        "the corners of the cells, the top row at +y.");
    picture.usual = "none";
    return {{"heightfield",
             "A shape over a rectangle round the origin, facing up: a sum of sines; or a mesh by "
             "fractal or filename, which takes no resolution.",
             joined(grid_keys(), {{.key = "waves",
                                   .meaning = "The sines that are added.",
                                   .type = "list of waves",
                                   .usual = "none"},
                                  {.key = "fractal",
                                   .meaning = "Fractal ground in place of waves.",
                                   .type = "object",
                                   .usual = "none"},
                                  picture,
                                  number("height", "Of the picture's value 1 (white) over 0.", "m",
                                         "1 with filename", "-1e+30 to 1e+30"),
                                  half_size()})}};
}

Objects within_heightfields() {
    return {
        {"wave",
         "An element of waves: amplitude sin(wave_vector . (x, y) + phase).",
         {number("amplitude", "Of the sine.", "m", "", "-1e+30 to 1e+30"),
          {.key = "wave_vector",
           .meaning = "Direction of the crests' motion; its length is 2 pi over the wavelength.",
           .unit = "rad/m",
           .type = "[x, y]"},
          number("phase", "At the origin.", "rad", "0", "-1e+30 to 1e+30")}},
        {"fractal",
         "In a heightfield: random waves that repeat with the rectangle; finer levels add shorter "
         "ones.",
         {whole("levels", "2^levels cells along x and y: 512 at 9, 33.6 million triangles at 12.",
                "", "", "2 to 12"),
          number("hurst", "From rough to smooth: (z(x + d) - z(x))^2 grows as |d|^(2 hurst).", "",
                 "0.8", "0 to 1"),
          number("rms", "Root of the mean square height, about 0.", "m", "", "0 to 1e+30"),
          number("lowest", "Waves along the longer side; longer waves are damped.", "waves", "1",
                 "1 to half the cells along x"),
          whole("seed", "Of the random numbers.", "", "0", "0 to 4294967295")}}};
}

Objects turned_and_cut() {
    KeyText inner{.key = "inner",
                  .meaning = "Of a bowl: a smooth inside, from the rim at the height to the axis.",
                  .type = "object",
                  .usual = "none"};
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
          yes_or_no("crease", "Splits the normal; without, it is smooth.", "false")}},
        {"cut",
         "A shape, a mesh: a gem or a cut bowl with flat facets, what is common to at most 200 "
         "half-spaces.",
         joined(turned_keys("Sectors of the inside."),
                {{.key = "rings",
                  .meaning = "Facets round z.",
                  .type = "list of rings",
                  .usual = "none"},
                 {.key = "planes",
                  .meaning = "Facets that look to (nx, ny, nz), d over its length from the origin.",
                  .unit = "m",
                  .type = "list of [nx, ny, nz, d]",
                  .usual = "none"},
                 number("height", "Cuts the top off at this z.", "m", "none", "-1e+30 to 1e+30"),
                 inner})},
        {"ring",
         "An element of rings.",
         {whole("count", "Of the ring's facets.", "", "", "1 to 200"),
          number("angle", "Elevation of what the facets look to: 0 outwards, 90 up, -90 down.",
                 "degrees", "", "-90 to 90"),
          number("distance", "Of the facets' planes from the origin.", "m", "", "-1e+30 to 1e+30"),
          number("phase", "Turns the ring, by facets; at 0 the first looks to +x.", "facets", "0",
                 "-1000 to 1000")}},
        {"inner", "In a cut.", profile_keys()}};
}

Objects shapes() {
    const KeyText radius = number("radius", "Of the shape.", "m", "1", "above 0 to 1e+30");
    const Keys mesh = mesh_keys();
    return {{"rectangle", "A shape: the square from -1 to 1 in x and y, facing +z.", grid_keys()},
            {"disk", "A shape: the unit disk across z, facing +z.", parametric_keys("1")},
            {"sphere", "A shape, facing outwards.",
             joined(parametric_keys("2"), {vector("center", "The middle.", "[0, 0, 0]"), radius})},
            {"cylinder", "A shape: an open tube, facing outwards.",
             joined(parametric_keys("1"), {vector("p0", "One end of the axis.", "[0, 0, 0]"),
                                           vector("p1", "The other end.", "[0, 0, 1]"), radius})},
            {"cube", "A shape: the box from -1 to 1, a mesh.", parametric_keys("1")},
            {"obj", "A shape: a mesh of a Wavefront file.",
             joined(mesh, {file("The .obj file, relative to the scene's.")})},
            {"ply", "A shape: a mesh of a PLY file.",
             joined(mesh, {file("The .ply file, relative to the scene's.")})}};
}

}  // namespace

Objects shape_keys() {
    Objects made;
    for (Objects family : {shapes(), heightfields(), within_heightfields(), turned_and_cut()})
        for (ObjectText& object : family) made.push_back(std::move(object));
    return made;
}

}  // namespace caustics::scene_file
