#include "core/picture/png_file.h"

#include <png.h>
#include <zlib.h>

#include <bit>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string_view>

#include "core/picture/picture_limits.h"

namespace caustics {
namespace {

// libpng leaves by longjmp(): nothing that has a destructor may be made below guarded().
extern "C" void fail_png(png_structp png, png_const_charp why) {
    *static_cast<std::string*>(png_get_error_ptr(png)) = why;
    png_longjmp(png, 1);
}

// A warning is no error, and nothing else is printed by libraries.
extern "C" void ignore_png(png_structp, png_const_charp) {}

extern "C" void read_png(png_structp png, png_bytep to, std::size_t count) {
    auto& rest = *static_cast<std::string_view*>(png_get_io_ptr(png));
    if (rest.size() < count) png_error(png, "the file ends early");
    std::memcpy(to, rest.data(), count);
    rest.remove_prefix(count);
}

extern "C" void write_png_bytes(png_structp png, png_bytep from, std::size_t count) {
    static_cast<std::string*>(png_get_io_ptr(png))
        ->append(reinterpret_cast<const char*>(from), count);
}

extern "C" void flush_png(png_structp) {}

/// Runs work() up to its end or to libpng's first error, which is thrown.
template <class Work>
void guarded(png_structp png, const std::string& why, const Work& work) {
    if (setjmp(png_jmpbuf(png)) != 0) throw std::runtime_error(why);
    work();
}

/// libpng's two structures, for reading or for writing.
class Png {
public:
    enum class Use { read, write };

    explicit Png(Use use) : use_(use) {
        const auto create = use == Use::read ? &png_create_read_struct : &png_create_write_struct;
        png = create(PNG_LIBPNG_VER_STRING, &why, fail_png, ignore_png);
        info = png != nullptr ? png_create_info_struct(png) : nullptr;
        if (info == nullptr) {
            destroy();
            throw std::bad_alloc();
        }
    }
    ~Png() { destroy(); }
    Png(const Png&) = delete;
    Png& operator=(const Png&) = delete;

    png_structp png = nullptr;
    png_infop info = nullptr;
    std::string why;

private:
    void destroy() {
        if (use_ == Use::read)
            png_destroy_read_struct(&png, &info, nullptr);
        else
            png_destroy_write_struct(&png, &info);
    }

    Use use_;
};

class PngSource : public PictureSource {
public:
    explicit PngSource(const std::string& bytes) : rest_(bytes) {
        guarded(file_.png, file_.why, [this] { read_header(); });
        shape_.format = "png";
    }

    void read_rows(int first, int last, float* values) override {
        if (pixels_.empty() || !is_whole()) decode(first, last);
        const std::size_t count = row_values(shape_) * static_cast<std::size_t>(last - first);
        const std::size_t begin =
            is_whole() ? row_values(shape_) * static_cast<std::size_t>(first) : 0;
        for (std::size_t i = begin; i < begin + count; ++i) *values++ = value(i);
    }

private:
    /// An interlaced picture is decoded at once.
    bool is_whole() const { return passes_ > 1; }

    void read_header() {
        png_structp png = file_.png;
        png_infop info = file_.info;
        png_set_read_fn(png, &rest_, read_png);
        png_read_info(png, info);
        png_set_expand(png);  // palettes, fewer than 8 bits, a transparent colour
        if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
        passes_ = png_set_interlace_handling(png);
        png_read_update_info(png, info);
        shape_.width = static_cast<int>(png_get_image_width(png, info));
        shape_.height = static_cast<int>(png_get_image_height(png, info));
        shape_.channels = png_get_channels(png, info);
        shape_.bytes_per_value = png_get_bit_depth(png, info) / 8;
    }

    void decode(int first, int last) {
        if (is_whole()) {
            first = 0;
            last = shape_.height;
        }
        const std::size_t row =
            row_values(shape_) * static_cast<std::size_t>(shape_.bytes_per_value);
        pixels_.resize(row * static_cast<std::size_t>(last - first));
        guarded(file_.png, file_.why, [this, row, first, last] {
            for (int pass = 0; pass < passes_; ++pass)
                for (int y = first; y < last; ++y)
                    png_read_row(file_.png, &pixels_[row * static_cast<std::size_t>(y - first)],
                                 nullptr);
            if (last == shape_.height) png_read_end(file_.png, nullptr);
        });
    }

    float value(std::size_t i) const {
        if (shape_.bytes_per_value == 1) return static_cast<float>(pixels_[i]) * (1 / 255.0F);
        std::uint16_t wide = 0;
        std::memcpy(&wide, &pixels_[2 * i], 2);
        return static_cast<float>(wide) * (1 / 65535.0F);
    }

    Png file_{Png::Use::read};
    std::string_view rest_;
    int passes_ = 1;
    std::vector<unsigned char> pixels_;  ///< of the rows that were read last, or of all
};

}  // namespace

bool is_png(const std::string& bytes) {
    constexpr std::size_t length = 8;
    return bytes.size() >= length &&
           png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, length) == 0;
}

std::unique_ptr<PictureSource> open_png(const std::string& bytes) {
    return std::make_unique<PngSource>(bytes);
}

std::string encode_png(int width, int height, const std::vector<unsigned char>& rgb) {
    Png file(Png::Use::write);
    std::string bytes;
    const std::size_t row = 3 * static_cast<std::size_t>(width);
    guarded(file.png, file.why, [&] {
        png_set_write_fn(file.png, &bytes, write_png_bytes, flush_png);
        png_set_IHDR(file.png, file.info, static_cast<png_uint_32>(width),
                     static_cast<png_uint_32>(height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                     PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        png_set_compression_level(file.png, 6);
        png_set_compression_strategy(file.png,
                                     Z_DEFAULT_STRATEGY);  // smaller than libpng's own choice
        // Says nothing, but keeps the bytes of the pictures that OpenImageIO wrote for this program.
        png_set_oFFs(file.png, file.info, 0, 0, PNG_OFFSET_PIXEL);
        png_write_info(file.png, file.info);
        for (int y = 0; y < height; ++y)
            png_write_row(file.png, &rgb[row * static_cast<std::size_t>(y)]);
        png_write_end(file.png, file.info);
    });
    return bytes;
}

}  // namespace caustics
