#include "core/material/texture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/picture/picture_file.h"

namespace caustics {
namespace {

float fraction(float x) { return x - std::floor(x); }

// A coordinate brought near the picture, where its texels' indices fit an int.
float folded(float x, Bitmap::Wrap wrap) {
    switch (wrap) {
        case Bitmap::Wrap::repeat: return fraction(x);
        case Bitmap::Wrap::mirror: return 2 * fraction(x / 2);
        case Bitmap::Wrap::clamp: break;
    }
    return std::clamp(x, 0.0F, 1.0F);
}

int wrapped(int i, int size, Bitmap::Wrap wrap) {
    if (wrap == Bitmap::Wrap::clamp) return std::clamp(i, 0, size - 1);
    const int period = wrap == Bitmap::Wrap::mirror ? 2 * size : size;
    const int inside = (i % period + period) % period;
    return inside < size ? inside : period - 1 - inside;
}

const Spectrum& texel(const Bitmap& bitmap, int x, int y) {
    const int column = wrapped(x, bitmap.width, bitmap.wrap);
    const int row = wrapped(y, bitmap.height, bitmap.wrap);
    return bitmap.texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(bitmap.width) +
                         static_cast<std::size_t>(column)];
}

Vec2 transformed(const Eigen::Affine3f& to_uv, const Vec2& uv) {
    return (to_uv * Vec3(uv.x(), uv.y(), 0)).head<2>();
}

struct Evaluate {
    Vec2 uv;

    Spectrum operator()(const Spectrum& constant) const { return constant; }
    Spectrum operator()(const Checkerboard& board) const {
        const Vec2 p = transformed(board.to_uv, uv);
        return (fraction(p.x()) > 0.5F) == (fraction(p.y()) > 0.5F) ? board.color0 : board.color1;
    }
    Spectrum operator()(const Bitmap& bitmap) const {
        if (bitmap.texels.empty()) throw std::logic_error("the texels of a picture were not read");
        const Vec2 p = transformed(bitmap.to_uv, uv);
        const float x = folded(p.x(), bitmap.wrap) * static_cast<float>(bitmap.width);
        const float y = folded(p.y(), bitmap.wrap) * static_cast<float>(bitmap.height);
        if (bitmap.filter == Bitmap::Filter::nearest)
            return texel(bitmap, static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
        // Texel centres lie at half-integers.
        const float left = std::floor(x - 0.5F);
        const float top = std::floor(y - 0.5F);
        const float fx = x - 0.5F - left;
        const float fy = y - 0.5F - top;
        const int i = static_cast<int>(left);
        const int j = static_cast<int>(top);
        return (1 - fy) * ((1 - fx) * texel(bitmap, i, j) + fx * texel(bitmap, i + 1, j)) +
               fy * ((1 - fx) * texel(bitmap, i, j + 1) + fx * texel(bitmap, i + 1, j + 1));
    }
};

struct AddTo {
    ValueHash& hash;

    void operator()(const Spectrum& constant) const { hash.add(constant); }
    void operator()(const Checkerboard& board) const {
        hash.add(board.color0);
        hash.add(board.color1);
        hash.add(board.to_uv.matrix());
    }
    void operator()(const Bitmap& bitmap) const {
        hash.add(bitmap.width);
        hash.add(bitmap.height);
        hash.add(bitmap.source);
        hash.add(bitmap.filter);
        hash.add(bitmap.wrap);
        hash.add(bitmap.to_uv.matrix());
    }
};

float srgb_to_linear(float v) {
    return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
}

}  // namespace

Spectrum evaluate(const Texture& texture, const Vec2& uv) {
    return std::visit(Evaluate{uv}, texture);
}

void add_to(ValueHash& hash, const Texture& texture) {
    hash.add(texture.index());
    std::visit(AddTo{hash}, texture);
}

Bitmap load_bitmap(PictureReader& reader, const std::filesystem::path& file, bool raw,
                   PictureDepth depth) {
    PictureFile picture(reader, file);
    const bool decode = !raw && !picture.shape().is_float;
    const auto channels = static_cast<std::size_t>(picture.shape().channels);
    // One or two channels are grey, with alpha ignored.
    const std::size_t step = channels >= 3 ? 1 : 0;
    Bitmap bitmap;
    bitmap.width = picture.shape().width;
    bitmap.height = picture.shape().height;
    bitmap.source = fnv1a(raw ? "raw" : "", picture.hash());
    if (depth == PictureDepth::header) return bitmap;
    bitmap.texels.reserve(picture.pixel_count());
    picture.read_rows([&](int y, const float* values) {
        for (int x = 0; x < bitmap.width; ++x, values += channels) {
            Spectrum texel;
            for (std::size_t c = 0; c < 3; ++c) {
                const float v = values[c * step];
                if (!std::isfinite(v) || v < 0)
                    throw InputError(file.string() + ": pixel (" + std::to_string(x) + ", " +
                                     std::to_string(y) + ") is negative or not finite");
                texel[static_cast<Eigen::Index>(c)] = decode ? srgb_to_linear(v) : v;
            }
            bitmap.texels.push_back(texel);
        }
    });
    return bitmap;
}

}  // namespace caustics
