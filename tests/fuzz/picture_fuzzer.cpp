#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/material/texture.h"
#include "core/picture/exr_file.h"
#include "core/picture/picture_format.h"
#include "core/picture/picture_limits.h"
#include "core/picture/png_file.h"
#include "core/render/film.h"
#include "tests/fuzz/reading.h"

namespace {

using namespace caustics;

/// How often the process that decodes ended, which costs its picture and nothing else.
struct DecodersThatEnded {
    int count = 0;
    ~DecodersThatEnded() { std::printf("%d decoders ended by a signal\n", count); }
} ended;

void read_all(PictureSource& source) {
    const PictureShape& shape = source.shape();
    const std::size_t most = most_texture_pixels(0);
    if (row_values(shape) > most || row_values(shape) * std::size_t(shape.height) > most) return;
    const int rows = rows_at_once(shape);
    std::vector<float> values(row_values(shape) * static_cast<std::size_t>(rows));
    for (int first = 0; first < shape.height; first += rows)
        source.read_rows(first, std::min(first + rows, shape.height), values.data());
}

/// The decoders that are our own, in this process.
void decode_here(const std::string& bytes, const std::string& format) {
    try {
        if (format == "png") read_all(*open_png(bytes));
        if (format == "openexr") read_all(*open_exr_film(bytes));
    } catch (const std::exception&) {
        return;
    }
}

void read_film(const std::filesystem::path& file) {
    const Film film = read_exr(file);
    for (const Plane& plane : film.planes())
        fuzz::require(plane.values.size() == film.pixel_count(), "a plane that is not whole");
    // What was read can be written, and is the same when read again.
    const auto again = fuzz::scratch() / "again.exr";
    write_exr(film, again);
    const Film copy = read_exr(again);
    fuzz::require(copy.planes().size() == film.planes().size() && copy.width() == film.width(),
                  "another picture when written and read");
}

void read_texture(const std::filesystem::path& file, bool raw) {
    static PictureReader reader;
    Bitmap bitmap;
    try {
        bitmap = load_bitmap(reader, file, raw);
    } catch (const InputError& error) {
        if (std::string(error.what()).find("ended by signal") != std::string::npos) ++ended.count;
        throw;
    }
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
    const std::string bytes(fuzz::view(data, size));
    const auto file = fuzz::put("picture", bytes);
    const std::string format = picture_format(bytes);
    decode_here(bytes, format);
    fuzz::taken(fuzz::Naming::file, [&] { read_texture(file, size % 2 == 0); });
    // A film has a process of its own, which takes long.
    if (format == "openexr" && fuzz::one_in(64, bytes))
        fuzz::taken(fuzz::Naming::file, [&] { read_film(file); });
    return 0;
}
