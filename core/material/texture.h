#pragma once

#include <cstdint>
#include <filesystem>
#include <variant>
#include <vector>

#include "core/math/spectrum.h"
#include "core/math/value_hash.h"
#include "core/math/vec.h"
#include "core/picture/picture_reader.h"

namespace caustics {

/// A picture as a reflectance, linear sRGB. v = 0 is the top row, as in Mitsuba.
struct Bitmap {
    enum class Filter { bilinear, nearest };
    enum class Wrap { repeat, mirror, clamp };

    int width = 0;
    int height = 0;
    std::vector<Spectrum> texels;  ///< row by row from the top; none where only the header was read
    std::uint64_t source = 0;      ///< hash of the file's bytes and of how they are read
    Filter filter = Filter::bilinear;
    Wrap wrap = Wrap::repeat;
    Eigen::Affine3f to_uv = Eigen::Affine3f::Identity();
};

/// Two colours by quadrants of the unit square, repeated: `color0` where (u > .5) == (v > .5)
/// (Mitsuba's `checkerboard`).
struct Checkerboard {
    Spectrum color0 = Spectrum::Constant(0.4F);
    Spectrum color1 = Spectrum::Constant(0.2F);
    Eigen::Affine3f to_uv = Eigen::Affine3f::Identity();
};

using Texture = std::variant<Spectrum, Checkerboard, Bitmap>;

/// Reflectance at texture coordinates (u, v). Throws std::logic_error for a picture of which only the header was read.
Spectrum evaluate(const Texture& texture, const Vec2& uv);
/// Adds all that evaluate() depends on.
void add_to(ValueHash& hash, const Texture& texture);

/// Reads a picture file of any format; 8- and 16-bit files are sRGB-decoded unless `raw`.
/// One channel is grey; alpha is ignored. Throws InputError.
Bitmap load_bitmap(PictureReader& reader, const std::filesystem::path& file, bool raw,
                   PictureDepth depth = PictureDepth::whole);

}  // namespace caustics
