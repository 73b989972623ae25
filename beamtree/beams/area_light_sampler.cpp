#include "beamtree/beams/area_light_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/geometry/surface_offset.h"
#include "core/math/sampling.h"

namespace caustics::beamtree {
namespace {

// Running sums over the total.
std::vector<double> cumulative(const std::vector<double>& weights) {
    std::vector<double> sums;
    double sum = 0;
    for (const double weight : weights) sums.push_back(sum += weight);
    if (sum > 0)
        for (double& share : sums) share /= sum;
    return sums;
}

// Over their mean, weighted by the sizes.
void normalise(std::vector<double>& densities, const std::vector<double>& sizes) {
    double total = 0;
    double size = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        total += densities[i] * sizes[i];
        size += sizes[i];
    }
    for (double& density : densities) density *= size / total;
}

bool is_flat(const std::vector<Vec3>& normals) {
    return std::ranges::all_of(normals, [&](const Vec3& n) { return n.dot(normals[0]) > 0.9999F; });
}

bool is_dark(const std::vector<double>& densities) {
    return std::ranges::all_of(densities, [](double density) { return density == 0; });
}

std::array<Vec3, 3> corners(const TriangleMesh& mesh, std::size_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

}  // namespace

AreaLightSampler::AreaLightSampler(const Scene& scene, const AreaLight& light)
    : shape_(scene.shapes()[light.shape]), even_(light.sampler) {
    for (const std::uint32_t caster : scene.casters())
        casters_.push_back(bounds(scene.shapes()[caster]));
    if (shape_.primitive == Primitive::mesh)
        weigh_triangles();
    else
        weigh_square();
}

// The sum over 27 places of a box of cosine / distance^2 at the lamp, in any unit. The distance is
// rounded off below an eighth of the box: places stand for their surroundings.
double AreaLightSampler::light_sent(const Vec3& position, const Vec3& normal) const {
    double sum = 0;
    for (const Box& box : casters_) {
        const float rounding = box.sizes().squaredNorm() / 64;
        for (int i = 0; i < 27; ++i) {
            const Vec3 share(static_cast<float>(i % 3), static_cast<float>(i / 3 % 3),
                             static_cast<float>(i / 9));
            const Vec3 towards = box.min() + Vec3(box.sizes().cwiseProduct(share / 2)) - position;
            const float height = normal.dot(towards);
            const auto square = static_cast<double>(towards.squaredNorm() + rounding);
            if (height > 0) sum += static_cast<double>(height) / (square * std::sqrt(square));
        }
    }
    return sum;
}

void AreaLightSampler::weigh_triangles() {
    std::vector<double> areas;
    std::vector<Vec3> normals;
    for (std::size_t i = 0; i < shape_.mesh.triangles.size(); ++i) {
        const auto [a, b, c] = corners(shape_.mesh, i);
        const Vec3d cross = (b - a).cast<double>().cross((c - a).cast<double>());
        areas.push_back(cross.norm() / 2);
        density_.push_back(0);
        if (cross.isZero(0)) continue;
        normals.push_back(cross.stableNormalized().cast<float>());
        density_.back() = light_sent((a + b + c) / 3, normals.back());
    }
    if (is_flat(normals) || is_dark(density_)) return density_.clear();
    normalise(density_, areas);
    for (std::size_t i = 0; i < areas.size(); ++i) areas[i] *= density_[i];
    cumulative_ = cumulative(areas);
}

// By cells of the square: from nine points of each, and what may lie above them between.
void AreaLightSampler::weigh_square() {
    constexpr std::size_t side = 2 * cells + 1;
    std::vector<double> sent;
    std::vector<Vec3> normals;
    for (std::size_t i = 0; i < side * side; ++i) {
        const auto at = [](std::size_t k) {
            return std::min(static_cast<float>(k) / (2 * cells), 0x1.fffffep-1F);
        };
        const auto point = even_.sample(shape_, at(i / side), at(i % side));
        sent.push_back(light_sent(point.position, point.normal));
        normals.push_back(point.normal);
    }
    if (is_flat(normals) || is_dark(sent)) return;
    for (std::size_t row = 0; row < cells; ++row)
        for (std::size_t column = 0; column < cells; ++column) {
            double least = std::numeric_limits<double>::infinity();
            double most = 0;
            for (std::size_t i = 0; i < 9; ++i) {
                const double one = sent[(2 * row + i / 3) * side + 2 * column + i % 3];
                least = std::min(least, one);
                most = std::max(most, one);
            }
            density_.push_back(most + (most - least) / 4);
        }
    normalise(density_, std::vector<double>(density_.size(), 1));
    std::vector<double> rows;
    for (std::size_t row = 0; row < cells; ++row) {
        const auto begin = density_.begin() + static_cast<std::ptrdiff_t>(row * cells);
        row_cumulative_.push_back(cumulative({begin, begin + cells}));
        rows.push_back(std::accumulate(begin, begin + cells, 0.0));
    }
    cumulative_ = cumulative(rows);
}

AreaLightSampler::Sample AreaLightSampler::sample(float u0, float u1) const {
    if (cumulative_.empty()) {
        const auto point = even_.sample(shape_, u0, u1);
        return {point.position, point.normal, point.offset, 1};
    }
    return shape_.primitive == Primitive::mesh ? sample_triangles(u0, u1) : sample_square(u0, u1);
}

AreaLightSampler::Sample AreaLightSampler::sample_triangles(float u0, float u1) const {
    auto rest = static_cast<double>(u0);
    const std::size_t index = pick_and_stretch(cumulative_, rest);
    const auto [a, b, c] = corners(shape_.mesh, index);
    const auto root = static_cast<float>(std::sqrt(rest));
    Sample sample{(1 - root) * a + root * (1 - u1) * b + root * u1 * c,
                  (b - a).cross(c - a).stableNormalized(), 0,
                  static_cast<float>(1 / density_[index])};
    // Twice, as this place is found in float.
    sample.offset = 2 * triangle_offset(sample.position, sample.normal, a, b, c);
    return sample;
}

AreaLightSampler::Sample AreaLightSampler::sample_square(float u0, float u1) const {
    std::array<double, 2> u = {static_cast<double>(u0), static_cast<double>(u1)};
    const std::size_t row = pick_and_stretch(cumulative_, u[0]);
    const std::size_t column = pick_and_stretch(row_cumulative_[row], u[1]);
    const auto in_square = [](std::size_t cell, double rest) {
        return std::min(static_cast<float>((static_cast<double>(cell) + rest) / cells),
                        0x1.fffffep-1F);
    };
    const auto point = even_.sample(shape_, in_square(row, u[0]), in_square(column, u[1]));
    return {point.position, point.normal, point.offset,
            static_cast<float>(1 / density_[row * cells + column])};
}

}  // namespace caustics::beamtree
