#include "core/texture.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/error.h"

namespace caustics {
namespace {

std::string one_line(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    return text;
}

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

float srgb_to_linear(float v) {
    return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
}

}  // namespace

Spectrum evaluate(const Texture& texture, const Vec2& uv) {
    return std::visit(Evaluate{uv}, texture);
}

Bitmap load_bitmap(const std::filesystem::path& file, bool raw) {
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;  // colours as written, not multiplied by alpha
    const auto input = OIIO::ImageInput::open(file.string(), &config);
    if (!input)
        throw InputError(file.string() + ": not a picture that can be read (" +
                         one_line(OIIO::geterror()) + ")");
    const OIIO::ImageSpec& spec = input->spec();
    const auto pixels =
        static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    const bool decode = !raw && spec.format.is_floating_point() == false;
    std::vector<float> values(pixels * channels);
    if (pixels == 0 ||
        !input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data()))
        throw InputError(file.string() + ": the picture is broken (" + one_line(input->geterror()) +
                         ")");
    Bitmap bitmap;
    bitmap.width = spec.width;
    bitmap.height = spec.height;
    bitmap.texels.resize(pixels);
    // One or two channels are grey, with alpha ignored.
    const std::size_t step = channels >= 3 ? 1 : 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        const float* p = &values[i * channels];
        for (std::size_t c = 0; c < 3; ++c) {
            const float v = p[c * step];
            if (!std::isfinite(v) || v < 0)
                throw InputError(file.string() + ": pixel (" +
                                 std::to_string(i % static_cast<std::size_t>(spec.width)) + ", " +
                                 std::to_string(i / static_cast<std::size_t>(spec.width)) +
                                 ") is negative or not finite");
            bitmap.texels[i][static_cast<Eigen::Index>(c)] = decode ? srgb_to_linear(v) : v;
        }
    }
    return bitmap;
}

}  // namespace caustics
