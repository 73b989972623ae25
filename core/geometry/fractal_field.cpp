#include "core/geometry/fractal_field.h"

#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "core/math/rng.h"

namespace caustics {
namespace {

using Complex = std::complex<double>;

// 2 pi over the rectangle's sides.
Vec2d base_wave(const FractalField& field) { return (pi_d / field.half_size.array()).matrix(); }

void reverse_bits(Complex* values, std::size_t count) {
    for (std::size_t i = 1, j = 0; i < count; ++i) {
        std::size_t bit = count >> 1U;
        for (; (j & bit) != 0; bit >>= 1U) j ^= bit;
        j ^= bit;
        if (i < j) std::swap(values[i], values[j]);
    }
}

// In place, values[j] = sum of values[m] exp(2 pi i m j / count); turns[m] = exp(2 pi i m / count).
// Radix 2 [Cooley and Tukey 1965].
void sum_waves(Complex* values, const std::vector<Complex>& turns) {
    throw_if_interrupted();
    const std::size_t count = turns.size();
    reverse_bits(values, count);
    for (std::size_t half = 1; half < count; half *= 2)
        for (std::size_t first = 0; first < count; first += 2 * half)
            for (std::size_t k = 0; k < half; ++k) {
                Complex& low = values[first + k];
                Complex& high = values[first + k + half];
                const Complex turned = high * turns[k * (count / (2 * half))];
                high = low - turned;
                low += turned;
            }
}

// A square of amplitudes that becomes one of heights.
class Waves {
public:
    explicit Waves(int size)
        : size_(static_cast<std::size_t>(size)), values_(size_ * size_), turns_(size_) {
        for (std::size_t m = 0; m < size_; ++m)
            turns_[m] = std::polar(1.0, 2 * pi_d * static_cast<double>(m) / size);
    }

    // Row n of the square holds the waves that run n times along y.
    Complex& at(int m, int n) { return values_[folded(n) * size_ + folded(m)]; }
    void sum() {
        for (std::size_t row = 0; row < size_; ++row) sum_waves(&values_[row * size_], turns_);
        std::vector<Complex> column(size_);
        for (std::size_t x = 0; x < size_; ++x) {
            for (std::size_t y = 0; y < size_; ++y) column[y] = values_[y * size_ + x];
            sum_waves(column.data(), turns_);
            for (std::size_t y = 0; y < size_; ++y) values_[y * size_ + x] = column[y];
        }
    }

private:
    std::size_t folded(int i) const {
        const int size = static_cast<int>(size_);
        return static_cast<std::size_t>((i % size + size) % size);
    }

    std::size_t size_;
    std::vector<Complex> values_, turns_;
};

// Fills the square with all amplitudes times a factor of (m, n), and sums.
template <class Factor>
void synthesize(Waves& waves, const FractalField& field, const Factor& factor) {
    const int half = 1 << (field.levels - 1);
    for (int n = -half; n < half; ++n) {
        throw_if_interrupted();
        for (int m = -half; m < half; ++m) {
            const bool resolved = m > -half && n > -half;
            waves.at(m, n) = resolved ? factor(m, n) * fractal_amplitude(field, m, n) : 0;
        }
    }
    waves.sum();
}

double mean_square(Waves& waves, int size) {
    double sum = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) sum += waves.at(x, y).real() * waves.at(x, y).real();
    return sum / size / size;
}

void add_slopes(HeightGrid& grid, Waves& waves, const FractalField& field, double scale) {
    const Vec2d wave = scale * base_wave(field);
    grid.slopes.resize(grid.heights.size());
    for (int axis = 0; axis < 2; ++axis) {
        synthesize(waves, field,
                   [&](int m, int n) { return Complex(0, wave[axis] * (axis == 0 ? m : n)); });
        for (int j = 0; j <= grid.rows; ++j)
            for (int i = 0; i <= grid.columns; ++i)
                grid.slopes[grid.index(i, j)][axis] = static_cast<float>(waves.at(i, j).real());
    }
}

}  // namespace

std::complex<double> fractal_amplitude(const FractalField& field, int m, int n) {
    if (m == 0 && n == 0) return 0;
    const Vec2d base = base_wave(field);
    // In waves along the longer side.
    const double k = Vec2d(m * base.x(), n * base.y()).norm() / base.minCoeff();
    const double damping = std::min(1.0, std::pow(k / field.lowest, 2));
    const auto words = philox4x32(
        {static_cast<std::uint32_t>(m), static_cast<std::uint32_t>(n), 0, 0},
        {static_cast<std::uint32_t>(field.seed), static_cast<std::uint32_t>(field.seed >> 32U)});
    // Box and Muller's pair of Gaussian numbers; the first one is in (0, 1].
    const double u = (static_cast<double>(words[0]) + 1) * 0x1p-32;
    const double angle = 2 * pi_d * static_cast<double>(words[1]) * 0x1p-32;
    return std::polar(damping * std::pow(k, -field.hurst - 1) * std::sqrt(-2 * std::log(u)), angle);
}

HeightGrid fractal_grid(const FractalField& field, bool unscaled) {
    if (field.levels < FractalField::least_levels || field.levels > FractalField::most_levels)
        throw InputError(fmt::format("levels {} are not in [{}, {}]", field.levels,
                                     FractalField::least_levels, FractalField::most_levels));
    const int size = 1 << field.levels;
    HeightGrid grid{.columns = size, .rows = size, .half_size = field.half_size};
    Waves waves(size);
    synthesize(waves, field, [](int, int) { return 1.0; });
    const double scale = unscaled ? 1 : field.rms / std::sqrt(mean_square(waves, size));
    for (int j = 0; j <= size; ++j)
        for (int i = 0; i <= size; ++i)
            grid.heights.push_back(static_cast<float>(scale * waves.at(i, j).real()));
    add_slopes(grid, waves, field, scale);
    return grid;
}

}  // namespace caustics
