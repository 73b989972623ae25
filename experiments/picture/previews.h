#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/render/film.h"

namespace caustics::experiments {

/// The rule of every tone-mapped picture, for --help and metadata.
extern const char* const tone_mapping_rule;

/// Exposure in stops that maps the 99th percentile of the layer's luminance, over pixels with any
/// light, to white; 0 for a black layer.
double auto_exposure(const Film& film, const std::string& layer);

/// A trial's picture. Throws InputError naming the file when it cannot be read or has no layer
/// "caustic".
Film read_caustic(const std::filesystem::path& file);

/// An 8-bit sRGB picture, 3 bytes a pixel, row by row from the top.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<unsigned char> rgb;
};

/// sRGB(clamp(value * 2^exposure, 0, 1)) of a layer ("" = beauty).
Picture tone_map(const Film& film, const std::string& layer, double exposure);

/// Signed error film - reference (mean of the channels): white at 0, red above, blue below, full
/// colour at +-scale and beyond; grey where `unreached`.
Picture signed_error(const Film& film, const Film& reference, const std::string& layer,
                     double scale);

/// Reference | picture | signed error, side by side with a thin gap. The exposure comes from the
/// reference; full colour of the error stands for a quarter of white, 2^-exposure / 4.
Picture strip(const Film& film, const Film& reference, const std::string& layer);

/// Throws InputError where the file that an option names for `what` is no .png, or cannot be put there.
void require_png(const std::string& option, const std::string& file, const std::string& what);
void write_png(const Picture& picture, const std::filesystem::path& file);

}  // namespace caustics::experiments
