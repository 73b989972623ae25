#include "tests/support/picture_agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/statistics.h"

namespace caustics::support {
namespace {

constexpr int enlarged = 16;  // screen pixels along a side of one of z.png

Spectrum error_at(const Film& film, std::size_t pixel) {
    return film.has_layer("stderr") ? film.rgb("stderr", pixel) : black();
}

bool is_reached(const Film& film, std::size_t pixel) {
    const std::vector<float>* const unreached = film.find("unreached.Y");
    return unreached == nullptr || (*unreached)[pixel] == 0;
}

double score(double x, double y, double error) {
    if (error > 0) return (x - y) / error;
    return x == y ? 0 : std::copysign(std::numeric_limits<double>::infinity(), x - y);
}

unsigned char screen(double share) {
    return static_cast<unsigned char>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

// White where both are equal.
void write_z_png(const PictureScores& scores, int width, int height, double bound,
                 const std::filesystem::path& file) {
    std::vector<unsigned char> rgb;
    for (int y = 0; y < height * enlarged; ++y)
        for (int x = 0; x < width * enlarged; ++x) {
            const auto at = static_cast<std::size_t>(y / enlarged * width + x / enlarged);
            const double share = static_cast<double>(scores.z[at].mean()) / bound;
            rgb.push_back(screen(1 + share));
            rgb.push_back(screen(1 - std::abs(share)));
            rgb.push_back(screen(1 - share));
        }
    write_png(width * enlarged, height * enlarged, rgb, file);
}

Film z_film(const PictureScores& scores, const Film& like) {
    Film film(like.width(), like.height());
    for (const char* channel : {"R", "G", "B"}) film.plane(channel);
    for (std::size_t i = 0; i < scores.z.size(); ++i) film.set_rgb("", i, scores.z[i]);
    return film;
}

}  // namespace

std::string ChannelScores::complaint(double sigma) const {
    if (pixels == 0) return "no pixel to compare; ";
    std::string text;
    if (const double bound = sidak_bound(3 * pixels); !(largest < bound))
        text += fmt::format("|z| = {:.2f} at pixel {}, the bound is {:.2f}; ", largest, largest_at,
                            bound);
    const double n = static_cast<double>(pixels);
    if (!(std::abs(mean_square - 1) < 5 * std::sqrt(2 / n)))
        text += fmt::format("mean z^2 = {:.3f} over {} pixels; ", mean_square, pixels);
    if (!(ratio_error <= sigma))
        text += fmt::format("the ratio of the means is sure to {:.5f} only; ", ratio_error);
    if (!(std::abs(ratio - 1) < 4 * ratio_error))
        text += fmt::format("ratio of the means {:.5f} +- {:.5f}; ", ratio, ratio_error);
    return text;
}

PictureScores::PictureScores(const Film& first, const Film& second)
    : z(first.pixel_count(), black()) {
    for (int c = 0; c < 3; ++c) {
        ChannelScores& of = channels[static_cast<std::size_t>(c)];
        double sum_x = 0, sum_y = 0, variance = 0, squares = 0;
        for (std::size_t i = 0; i < first.pixel_count(); ++i) {
            const auto x = static_cast<double>(first.rgb("caustic", i)[c]);
            const auto y = static_cast<double>(second.rgb("caustic", i)[c]);
            if (!is_reached(first, i) || !is_reached(second, i) || (x == 0 && y == 0)) continue;
            const double error = std::hypot(static_cast<double>(error_at(first, i)[c]),
                                            static_cast<double>(error_at(second, i)[c]));
            const double at = score(x, y, error);
            z[i][c] = static_cast<float>(at);
            if (!(std::abs(at) <= of.largest)) {
                of.largest = std::abs(at);
                of.largest_at = i;
            }
            ++of.pixels;
            sum_x += x;
            sum_y += y;
            variance += error * error;
            squares += at * at;
        }
        of.mean_square = squares / static_cast<double>(of.pixels);
        of.ratio = sum_x / sum_y;
        of.ratio_error = std::sqrt(variance) / sum_y;
    }
}

std::string PictureScores::complaint(double sigma) const {
    std::string text;
    for (std::size_t c = 0; c < 3; ++c)
        if (const std::string one = channels[c].complaint(sigma); !one.empty())
            text += fmt::format("{}: {}", "RGB"[c], one);
    return text;
}

std::string disagreement(const Film& first, const Film& second, double sigma,
                         const std::filesystem::path& folder) {
    const PictureScores scores(first, second);
    const std::string complaint = scores.complaint(sigma);
    if (complaint.empty()) return {};
    std::filesystem::create_directories(folder);
    write_exr(first, folder / "first.exr");
    write_exr(second, folder / "second.exr");
    write_exr(z_film(scores, first), folder / "z.exr");
    write_z_png(scores, first.width(), first.height(), sidak_bound(3 * first.pixel_count()),
                folder / "z.png");
    return fmt::format("{}pictures: {}/{{first,second,z}}.exr, z.png", complaint, folder.string());
}

}  // namespace caustics::support
