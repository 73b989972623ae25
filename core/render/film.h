#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/math/spectrum.h"

namespace caustics {

/// One float32 plane of a picture, row by row from the top.
struct Plane {
    std::string channel;  ///< EXR channel name: "R", "caustic.R", "depth.Z", ...
    std::vector<float> values;
};

/// A picture of named planes. Layers of the contract: beauty (unnamed R, G, B), direct, caustic,
/// specular, indirect (where it is asked for), albedo, normal (.X .Y .Z), depth (.Z), and where they apply
/// unreached (.Y, share of the pixel's samples that `lighttrace` cannot reach), ambient (of a scene that has such
/// light), stderr (.R .G .B, of the caustic layer), indirect_stderr and samples (.Y, their number where sampling
/// is adaptive).
class Film {
public:
    Film(int width, int height) : width_(width), height_(height) {}

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t pixel_count() const {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    }

    /// The plane of that channel, made zero when new; the reference outlives planes added later.
    std::vector<float>& plane(const std::string& channel);
    /// The plane of that channel, or nullptr.
    const std::vector<float>* find(const std::string& channel) const;
    bool has_layer(const std::string& layer) const;
    /// R, G, B of a layer ("" = beauty) at a pixel. Throws std::logic_error when there is no such
    /// layer.
    Spectrum rgb(const std::string& layer, std::size_t pixel) const;
    void set_rgb(const std::string& layer, std::size_t pixel, const Spectrum& value);
    const std::deque<Plane>& planes() const { return planes_; }

    /// String attributes written with the picture: the resolved configuration, provenance.
    std::map<std::string, std::string> metadata;

private:
    int width_;
    int height_;
    std::deque<Plane> planes_;
};

/// Writes one float32 multi-layer EXR to a temporary name beside `file` and renames it. The same
/// picture gives the same bytes. Throws InputError when it cannot be written.
void write_exr(const Film& film, const std::filesystem::path& file);
/// Reads an EXR with all its float channels. Throws InputError.
Film read_exr(const std::filesystem::path& file);
/// Writes 8-bit sRGB pixels (3 bytes each, row by row) as PNG, to a temporary name, then renamed.
void write_png(int width, int height, const std::vector<unsigned char>& rgb,
               const std::filesystem::path& file);

}  // namespace caustics
