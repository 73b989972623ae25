#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/render/film.h"
#include "tests/support/test_name.h"

namespace caustics::support {

/// z-scores of one channel of two caustics, by the standard errors of both: layer `stderr`, without
/// which a picture is a truth. Pixels that particles cannot reach (`unreached`) and those that are black in
/// both are left out.
struct ChannelScores {
    std::size_t pixels = 0;
    double largest = 0;  ///< |z|; infinite where pixels differ that have no error
    std::size_t largest_at = 0;
    double mean_square = 0;  ///< of z
    double ratio = 1;        ///< of the first mean to the second
    double ratio_error = 0;  ///< its standard error

    /// What chance does not explain, or is not told well enough: a z beyond Sidak's bound for all
    /// pixels and channels, a mean square 5 sigma from 1, means 4 sigma apart, a sigma above `sigma`.
    /// Empty if all is well.
    std::string complaint(double sigma) const;
};

struct PictureScores {
    std::array<ChannelScores, 3> channels;
    std::vector<Spectrum> z;  ///< by pixel, 0 for those left out

    PictureScores(const Film& first, const Film& second);
    /// Of all channels, by name.
    std::string complaint(double sigma) const;
};

/// Where a test that fails leaves its pictures: below the folder it runs in.
inline std::filesystem::path failed_pictures() {
    return std::filesystem::current_path() / "failed_pictures" / test_name();
}

/// Empty if the two pictures agree; else the complaint, and where first.exr, second.exr, z.exr and z.png
/// (red: the first is brighter, blue: darker, full at Sidak's bound) were written.
std::string disagreement(const Film& first, const Film& second, double sigma,
                         const std::filesystem::path& folder = failed_pictures());

}  // namespace caustics::support
