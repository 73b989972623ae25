#include <cmath>

#include "core/material/texture.h"
#include "core/render/film.h"
#include "tests/fuzz/reading.h"

namespace {

using namespace caustics;

void read_picture(const std::filesystem::path& file, bool again_too) {
    const Film film = read_exr(file);
    for (const Plane& plane : film.planes())
        fuzz::require(plane.values.size() == film.pixel_count(), "a plane that is not whole");
    if (!again_too) return;
    // What was read can be written, and is the same when read again.
    const auto again = fuzz::scratch() / "again.exr";
    write_exr(film, again);
    const Film copy = read_exr(again);
    fuzz::require(copy.planes().size() == film.planes().size() && copy.width() == film.width(),
                  "another picture when written and read");
}

void read_texture(const std::filesystem::path& file, bool raw) {
    Bitmap bitmap = load_bitmap(file, raw);
    for (const Spectrum& texel : bitmap.texels)
        fuzz::require(is_finite(texel) && texel.minCoeff() >= 0, "a texel that is no reflectance");
    for (const auto wrap : {Bitmap::Wrap::repeat, Bitmap::Wrap::mirror, Bitmap::Wrap::clamp})
        for (const float u : {-1e30F, -1.0F, 0.0F, 0.25F, 1.0F, 1e30F}) {
            bitmap.wrap = wrap;
            bitmap.filter = u < 0 ? Bitmap::Filter::nearest : Bitmap::Filter::bilinear;
            fuzz::require(is_finite(evaluate(bitmap, Vec2(u, 0.5F))), "no reflectance at a point");
        }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes = fuzz::view(data, size);
    const bool is_exr = bytes.starts_with("\x76\x2f\x31\x01");
    const bool is_png = bytes.starts_with("\x89PNG");
    const bool chosen = fuzz::one_in(16, bytes);
    const auto file = fuzz::put(is_exr ? "picture.exr" : "picture.png", bytes);
    if (is_exr || chosen) fuzz::taken(fuzz::Naming::file, [&] { read_picture(file, chosen); });
    // What is no PNG goes to OpenImageIO, which takes long.
    if (is_png || chosen)
        fuzz::taken(fuzz::Naming::file, [&] { read_texture(file, size % 2 == 0); });
    return 0;
}
