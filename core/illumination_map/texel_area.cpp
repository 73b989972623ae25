#include "core/illumination_map/texel_area.h"

#include <string>

#include "core/base/error.h"
#include "core/geometry/exact_shape.h"

namespace caustics {
namespace {

/// By this much of the unit square, or of a texel, texture coordinates may leave it or overlap:
/// rounding.
constexpr double outside_tolerance = 1e-5;
constexpr double overlap_tolerance = 0.01;
constexpr const char* overlap = "has texture coordinates that overlap";

/// Where the shares of texels change their slopes: 0, the centres, 1.
std::vector<double> breaks(int resolution) {
    std::vector<double> all{0};
    for (int i = 0; i < resolution; ++i) all.push_back((i + 0.5) / resolution);
    all.push_back(1);
    return all;
}

void add(const TexelGrid& grid, const Vec2d& uv, double area, std::vector<double>& areas) {
    for (const TexelGrid::Tap& tap : grid.taps(uv)) areas[tap.texel] += tap.share * area;
}

/// Three points a cell and coordinate (Gauss and Legendre): to the fifth power exactly.
void integrate_exact(const Shape& shape, const TexelGrid& grid, std::vector<double>& areas) {
    constexpr double places[] = {0.5 - 0.3872983346207417, 0.5, 0.5 + 0.3872983346207417};
    constexpr double weights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    const std::vector<double> at = breaks(grid.resolution());
    for (std::size_t row = 0; row + 1 < at.size(); ++row)
        for (std::size_t column = 0; column + 1 < at.size(); ++column) {
            const Vec2d low(at[column], at[row]);
            const Vec2d size = Vec2d(at[column + 1], at[row + 1]) - low;
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 3; ++j) {
                    const Vec2d uv = low + size.cwiseProduct(Vec2d(places[i], places[j]));
                    const double weight = weights[i] * weights[j] * size.x() * size.y();
                    add(grid, uv, weight * exact_area_element(shape, uv), areas);
                }
        }
}

/// The part of a convex polygon where sign * (p[axis] - bound) >= 0.
std::vector<Vec2d> cut(const std::vector<Vec2d>& polygon, int axis, double bound, double sign) {
    std::vector<Vec2d> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec2d& p = polygon[i];
        const Vec2d& q = polygon[(i + 1) % polygon.size()];
        const double inside_p = sign * (p[axis] - bound);
        const double inside_q = sign * (q[axis] - bound);
        if (inside_p >= 0) kept.push_back(p);
        if ((inside_p > 0 && inside_q < 0) || (inside_p < 0 && inside_q > 0))
            kept.emplace_back(p + inside_p / (inside_p - inside_q) * (q - p));
    }
    return kept;
}

/// Areas of the texels under a mesh, triangle by triangle.
class MeshAreas {
public:
    MeshAreas(const Shape& shape, const TexelGrid& grid, std::vector<double>& areas)
        : shape_(shape),
          grid_(grid),
          areas_(areas),
          breaks_(breaks(grid.resolution())),
          covered_((breaks_.size() - 1) * (breaks_.size() - 1)) {
        if (shape.mesh.uvs.empty()) fail("has no texture coordinates");
    }

    void add_all() {
        for (const auto& triangle : shape_.mesh.triangles) add_triangle(triangle);
        const std::size_t cells = breaks_.size() - 1;
        for (std::size_t row = 0; row < cells; ++row)
            for (std::size_t column = 0; column < cells; ++column) {
                const double cell =
                    (breaks_[column + 1] - breaks_[column]) * (breaks_[row + 1] - breaks_[row]);
                if (covered_[row * cells + column] > (1 + overlap_tolerance) * cell) fail(overlap);
            }
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw UnsupportedScene(
            "illuminationmap needs texture coordinates that name one place of "
            "a receiver each, and the mesh \"" +
            shape_.name + "\" " + what + " (photonmap and the references do without)");
    }

    void add_triangle(const std::array<std::uint32_t, 3>& triangle) {
        std::vector<Vec2d> corners;
        Vec3d places[3];
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec2d uv = shape_.mesh.uvs[triangle[i]].cast<double>();
            if (uv.minCoeff() < -outside_tolerance || uv.maxCoeff() > 1 + outside_tolerance)
                fail("has texture coordinates outside the unit square");
            corners.push_back(uv.cwiseMax(0).cwiseMin(1));
            places[i] = shape_.mesh.positions[triangle[i]].cast<double>();
        }
        const double area = (places[1] - places[0]).cross(places[2] - places[0]).norm() / 2;
        const double mapped = std::abs(cross(corners[1] - corners[0], corners[2] - corners[0])) / 2;
        if (area == 0) return;
        if (!(mapped > 0)) fail("has a triangle whose texture coordinates span no area");
        // The square is full: the cells would show it, but later.
        mapped_ += mapped;
        if (mapped_ > 1 + overlap_tolerance) fail(overlap);
        for_each_cell(corners, area / mapped);
    }

    std::size_t cell_of(double x) const {
        return static_cast<std::size_t>(x * grid_.resolution() + 0.5);
    }

    void for_each_cell(const std::vector<Vec2d>& triangle, double element) {
        Vec2d low = triangle[0], high = triangle[0];
        for (const Vec2d& corner : triangle) {
            low = low.cwiseMin(corner).eval();
            high = high.cwiseMax(corner).eval();
        }
        for (std::size_t row = cell_of(low.y()); row <= cell_of(high.y()); ++row) {
            const auto strip = cut(cut(triangle, 1, breaks_[row], 1), 1, breaks_[row + 1], -1);
            if (strip.size() < 3) continue;
            for (std::size_t column = cell_of(low.x()); column <= cell_of(high.x()); ++column) {
                const auto part =
                    cut(cut(strip, 0, breaks_[column], 1), 0, breaks_[column + 1], -1);
                if (part.size() < 3) continue;
                covered_[row * (breaks_.size() - 1) + column] += add_part(part, element);
            }
        }
    }

    /// Shares are bilinear in a cell: the rule of the three edges' middles is exact. Returns the part's
    /// area in texture coordinates.
    double add_part(const std::vector<Vec2d>& part, double element) {
        double mapped = 0;
        for (std::size_t i = 1; i + 1 < part.size(); ++i) {
            const Vec2d &a = part[0], &b = part[i], &c = part[i + 1];
            const double third = std::abs(cross(b - a, c - a)) / 6;
            for (const Vec2d& middle : {Vec2d((a + b) / 2), Vec2d((b + c) / 2), Vec2d((c + a) / 2)})
                add(grid_, middle, third * element, areas_);
            mapped += 3 * third;
        }
        return mapped;
    }

    const Shape& shape_;
    const TexelGrid& grid_;
    std::vector<double>& areas_;
    std::vector<double> breaks_;
    std::vector<double> covered_;  ///< of each cell between the breaks
    double mapped_ = 0;            ///< of the unit square, by all triangles
};

}  // namespace

TexelGrid texel_grid(const Shape& shape, int resolution) {
    if (shape.primitive == Primitive::mesh) return {resolution, false, false};
    return ask_exact(
        shape, [&](const auto& kind) { return TexelGrid(resolution, kind.round_u, kind.round_v); });
}

std::vector<double> texel_areas(const Shape& shape, const TexelGrid& grid) {
    std::vector<double> areas(grid.size());
    if (shape.primitive == Primitive::mesh)
        MeshAreas(shape, grid, areas).add_all();
    else
        integrate_exact(shape, grid, areas);
    return areas;
}

}  // namespace caustics
