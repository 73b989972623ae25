#include "core/shapes/heightfield_shape.h"

#include <cmath>

#include <fmt/format.h>

#include "core/exact_shapes/shape_keys.h"
#include "core/geometry/fractal_field.h"
#include "core/math/coordinate_limit.h"
#include "core/picture/picture_file.h"

namespace caustics::scene_file {
namespace {

SineWave read_wave(const JsonNode& node) {
    SineWave wave;
    wave.amplitude = node.at("amplitude").as_number_in(-unlimited, unlimited);
    wave.wave_vector = read_pair(node.at("wave_vector"));
    if (const auto phase = node.find("phase"))
        wave.phase = phase->as_number_in(-most_turned, most_turned);
    node.finish();
    return wave;
}

// A ray is marched from crest to crest, and a double resolves none of more.
void require_few_crests(const JsonNode& node, const SineWave& wave, const Vec2d& half_size) {
    constexpr double most_crests = 10'000;
    const double crests = wave.wave_vector.cwiseAbs().dot(half_size) / pi_d;
    if (!(crests <= most_crests))
        node.at("wave_vector")
            .fail(fmt::format("makes {:.3g} crests across the rectangle, more than {:.0f}", crests,
                              most_crests));
}

HeightGrid read_fractal(const JsonNode& node, const Vec2d& half_size) {
    FractalField field;
    field.half_size = half_size;
    field.levels = static_cast<int>(
        node.at("levels").as_integer_in(FractalField::least_levels, FractalField::most_levels));
    field.rms = node.at("rms").as_number_in(0, unlimited);
    if (const auto hurst = node.find("hurst")) field.hurst = hurst->as_number_in(0, 1);
    if (const auto lowest = node.find("lowest"))
        field.lowest = lowest->as_number_in(1, std::exp2(field.levels - 1));
    if (const auto seed = node.find("seed"))
        field.seed = static_cast<std::uint64_t>(seed->as_integer_in(0, 4294967295));
    node.finish();
    return make_for(node, [&] { return fractal_grid(field); });
}

// Pixels are the corners of the cells; the top row lies at +y, as the picture looks from above.
HeightGrid load_heights(PictureReader& reader, const std::filesystem::path& file, double height) {
    PictureFile picture(reader, file);
    const PictureShape& shape = picture.shape();
    if (shape.channels != 1)
        picture.fail(fmt::format("heights are one channel, and not {}", shape.channels));
    if (shape.bytes_per_value < 2)
        picture.fail("heights of 8 bits are a flight of stairs; use a 16-bit PNG or an EXR file");
    HeightGrid grid{.columns = shape.width - 1, .rows = shape.height - 1};
    const int most = HeightGrid::most_cells;
    if (grid.columns < 1 || grid.rows < 1 || grid.columns > most || grid.rows > most)
        picture.fail(fmt::format("heights are 2 to {} pixels wide and high, and not {} x {}",
                                 most + 1, shape.width, shape.height));
    grid.heights.resize(picture.pixel_count());
    picture.read_rows([&](int y, const float* values) {
        for (int x = 0; x <= grid.columns; ++x) {
            const double z = height * static_cast<double>(values[x]);
            if (!(std::abs(z) <= unlimited))
                picture.fail(fmt::format("pixel ({}, {}) is no height", x, y));
            grid.heights[grid.index(x, grid.rows - y)] = static_cast<float>(z);
        }
    });
    return grid;
}

HeightGrid read_picture(const JsonNode& name, const std::optional<JsonNode>& height,
                        const Vec2d& half_size, Assets& assets) {
    const double metres = height ? height->as_number_in(-unlimited, unlimited) : 1;
    const std::filesystem::path file = read_file_name(name, assets);
    HeightGrid grid = load_for(name, [&] { return load_heights(assets.pictures, file, metres); });
    grid.half_size = half_size;
    return grid;
}

Vec2d read_half_size(const JsonNode& node) {
    const auto half_size = node.find("half_size");
    if (!half_size) return Vec2d::Ones();
    const std::vector<double> half = half_size->as_numbers(2);
    for (const JsonNode& side : half_size->as_array()) side.as_number_in(0, unlimited);
    if (half[0] <= 0 || half[1] <= 0) half_size->fail("must be above 0");
    return {half[0], half[1]};
}

KeyText half_size_key() {
    return {.key = "half_size",
            .meaning = "Half the rectangle's extent in x and y.",
            .unit = "m",
            .type = "[x, y]",
            .usual = "[1, 1]"};
}

}  // namespace

bool is_height_grid(const JsonNode& node) { return node.has("fractal") || node.has("filename"); }

std::variant<SineHeightfield, HeightGrid> read_heights(const JsonNode& node, Assets& assets) {
    const auto waves = node.find("waves");
    const auto fractal = node.find("fractal");
    const auto name = node.find("filename");
    const auto height = node.find("height");
    const Vec2d half_size = read_half_size(node);
    if (int{waves.has_value()} + int{fractal.has_value()} + int{name.has_value()} != 1)
        node.fail("a heightfield takes one of waves, fractal and filename");
    if (height && !name) height->fail("only heights of a file are scaled");
    if (fractal) return read_fractal(*fractal, half_size);
    if (name) return read_picture(*name, height, half_size, assets);
    SineHeightfield field;
    field.half_size = half_size;
    for (const JsonNode& wave : waves->as_array()) {
        field.waves.push_back(read_wave(wave));
        require_few_crests(wave, field.waves.back(), half_size);
    }
    return field;
}

Objects heightfield_keys() {
    KeyText picture = file(
        "Heights by a picture of one channel, 16-bit PNG or EXR, in place of waves; its pixels are "
        "the corners of the cells, the top row at +y.");
    picture.usual = "none";
    return {
        {"heightfield",
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
                              half_size_key()})},
        {"wave",
         "An element of waves: amplitude sin(wave_vector . (x, y) + phase).",
         {number("amplitude", "Of the sine.", "m", "", "-1e+30 to 1e+30"),
          {.key = "wave_vector",
           .meaning = "Direction of the crests' motion; its length is 2 pi over the wavelength.",
           .unit = "rad/m",
           .type = "[x, y]"},
          number("phase", "At the origin.", "rad", "0", "-1e+06 to 1e+06")}},
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

}  // namespace caustics::scene_file
