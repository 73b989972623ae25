#include "beamtree/pencils/pencil_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/isa.h"
#include "core/math/frame.h"
#include "core/math/rng.h"
#include "core/math/sampling.h"
#include "core/math/vec.h"

namespace caustics::beamtree {
namespace {

/// A convex polygon in numbers along a print's sides, cut edge by edge.
struct Outline {
    std::vector<Vec2d> corners;

    const Vec2d& after(std::size_t i) const { return corners[(i + 1) % corners.size()]; }
    /// Clips to the half plane sign * p[axis] <= 1 / 2.
    void cut(Eigen::Index axis, double sign) {
        std::vector<Vec2d> kept;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const double beyond_a = sign * corners[i][axis] - 0.5;
            const double beyond_b = sign * after(i)[axis] - 0.5;
            if (beyond_a <= 0) kept.push_back(corners[i]);
            if (beyond_a * beyond_b < 0)
                kept.emplace_back(corners[i] +
                                  beyond_a / (beyond_a - beyond_b) * (after(i) - corners[i]));
        }
        corners = kept;
    }
    double area() const {
        double twice = 0;
        for (std::size_t i = 0; i < corners.size(); ++i)
            twice += corners[i].x() * after(i).y() - corners[i].y() * after(i).x();
        return std::abs(twice) / 2;
    }
};

Vec3 row(const float (&rows)[3][pencil_width], std::size_t i) {
    return {rows[0][i], rows[1][i], rows[2][i]};
}
void put(float (&rows)[3][pencil_width], std::size_t i, const Vec3& v) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) rows[axis][i] = v[axis];
}

class Cases {
public:
    explicit Cases(std::uint64_t number) : rng_(1, Stage::test, number) {}

    /// A leaf of random prints on the plane z = 0. About one slot in five is empty.
    PencilLeaf leaf() {
        PencilLeaf leaf{};
        for (std::size_t i = 0; i < pencil_width; ++i) {
            leaf.height[i] = -1;
            leaf.area[i] = 1;
            if (rng_.next() < 0.2F) continue;
            const Vec3d wi = Vec3d(number(), number(), 1.2).normalized();
            const double size = std::pow(10.0, 2 * number()),
                         thinness = std::pow(10.0, number() - 1);
            const Frame across(wi.cast<float>());
            const Vec3d s = across.s.cast<double>(), t = across.t.cast<double>();
            const Vec3d a = size * (s + number() * t);
            const Vec3d b = size * thinness * (t + number() * s);
            const double turn = wi.dot(a.cross(b));
            put(leaf.position, i, Vec3d(size * number(), size * number(), 0).cast<float>());
            put(leaf.normal, i, Vec3::UnitZ());
            put(leaf.wi, i, wi.cast<float>());
            const std::array<Vec3d, 2> by_side = {b.cross(wi) / turn, wi.cross(a) / turn};
            for (std::size_t k = 0; k < 2; ++k) {
                put(leaf.by_side[k], i, by_side[k].cast<float>());
                leaf.by_metre[k][i] = static_cast<float>(by_side[k].norm());
            }
            leaf.height[i] = 0.01F;
            leaf.area[i] = static_cast<float>(std::abs(turn));
        }
        return leaf;
    }

    /// A cell of any size and convex shape beside the origin, or a point.
    PencilQuery query() {
        PencilQuery query{};
        query.normal[2] = 1;
        query.position[0] = static_cast<float>(number());
        query.position[1] = static_cast<float>(number());
        if (rng_.next() < 0.2F) return query;
        const double size = std::pow(10.0, 2 * number());
        std::array<Vec2d, 4> corners;
        for (std::size_t c = 0; c < 4; ++c) {
            const double angle = (static_cast<double>(c) + 0.3 * number()) * pi_d / 2;
            corners[c] = size * Vec2d(std::cos(angle), 0.4 * std::sin(angle));
            query.corner[c][0] = static_cast<float>(corners[c].x());
            query.corner[c][1] = static_cast<float>(corners[c].y());
            query.radius = std::max(query.radius, static_cast<float>(corners[c].norm()));
        }
        query.over_area = 1 / Outline{{corners.begin(), corners.end()}}.area();
        return query;
    }

    double number() { return 2 * rng_.next_fine() - 1; }

private:
    Rng rng_;
};

/// The density of a print, by clipping the cell.
double density_by_cutting(const PencilLeaf& leaf, std::size_t i, const PencilQuery& query) {
    if (leaf.height[i] < 0) return 0;
    const Vec3 at =
        Vec3(query.position[0], query.position[1], query.position[2]) - row(leaf.position, i);
    const auto along = [&](const Vec3& way) {
        return Vec2d(row(leaf.by_side[0], i).cast<double>().dot(way.cast<double>()),
                     row(leaf.by_side[1], i).cast<double>().dot(way.cast<double>()));
    };
    const double cosine = static_cast<double>(leaf.wi[2][i]);
    if (query.over_area == 0)
        return along(at).cwiseAbs().maxCoeff() <= 0.5 ? cosine / static_cast<double>(leaf.area[i])
                                                      : 0;
    Outline cell;
    for (const auto& corner : query.corner)
        cell.corners.push_back(along(at + Vec3(corner[0], corner[1], corner[2])));
    for (const Eigen::Index axis : {0, 1})
        for (const double sign : {1.0, -1.0}) cell.cut(axis, sign);
    return cell.corners.empty() ? 0 : cell.area() * query.over_area;
}

std::vector<const PencilKernels*> all_kernels() {
    std::vector<const PencilKernels*> all;
    for (const Isa isa : supported_isas()) all.push_back(&pencil_kernels(isa));
    return all;
}

TEST(PencilLeaf, BringsThePartOfACellThatCuttingLeaves) {
    int partly = 0, wholly = 0, none = 0;
    for (std::uint64_t n = 0; n < 20'000; ++n) {
        Cases cases(n);
        const PencilLeaf leaf = cases.leaf();
        const PencilQuery query = cases.query();
        std::array<double, pencil_width> density = {};
        plain_pencil_kernels().densities(leaf, query, density.data());
        for (std::size_t i = 0; i < pencil_width; ++i) {
            const double truth = density_by_cutting(leaf, i, query);
            const double whole = leaf.height[i] < 0 ? 0
                                                    : static_cast<double>(leaf.wi[2][i]) /
                                                          static_cast<double>(leaf.area[i]);
            // Numbers along sides are sums of floats as large as the way to the cell over the print's width.
            const double way =
                static_cast<double>(query.radius) +
                (Vec3(query.position[0], query.position[1], 0) - row(leaf.position, i))
                    .cast<double>()
                    .norm();
            const double numbers_by_metre =
                static_cast<double>(leaf.by_metre[0][i] + leaf.by_metre[1][i]);
            const double rounding = 1e-6 * (1 + way * numbers_by_metre);
            // A shift of the cell's outline by the rounding changes the area by at most the outline's length times it.
            const double outline =
                std::min(4.0, 4 * static_cast<double>(query.radius) * numbers_by_metre);
            if (query.over_area == 0)
                EXPECT_EQ(density[i], truth);
            else
                EXPECT_NEAR(density[i], truth, rounding * outline * query.over_area + 1e-6 * truth);
            ++(density[i] == 0 ? none : density[i] < whole * (1 - 1e-6) ? partly : wholly);
        }
    }
    EXPECT_GT(std::min({partly, wholly, none}), 2000);
}

TEST(PencilLeaf, GivesTheSameBitsOnEveryInstructionSet) {
    for (const PencilKernels* const kernels : all_kernels())
        for (std::uint64_t n = 0; n < 5000; ++n) {
            Cases cases(n);
            const PencilLeaf leaf = cases.leaf();
            const PencilQuery query = cases.query();
            std::array<double, pencil_width> plain = {}, wide = {};
            ASSERT_EQ(plain_pencil_kernels().densities(leaf, query, plain.data()),
                      kernels->densities(leaf, query, wide.data()));
            ASSERT_EQ(plain, wide);
        }
}

TEST(PencilBoxes, AreTouchedByABall) {
    for (std::uint64_t n = 0; n < 2000; ++n) {
        Cases cases(n);
        PencilBoxes boxes{};
        std::uint32_t truth = 0;
        const PencilQuery query = cases.query();
        const Vec3 at(query.position[0], query.position[1], query.position[2]);
        for (std::uint32_t i = 0; i < pencil_width; ++i) {
            Box box;
            for (int k = 0; k < 2; ++k)
                if (i != 3)
                    box.extend(Vec3d(2 * cases.number(), 2 * cases.number(), cases.number())
                                   .cast<float>());
            put(boxes.low, i, box.min());
            put(boxes.high, i, box.max());
            if (box.squaredExteriorDistance(at) <= query.radius * query.radius) truth |= 1U << i;
        }
        for (const PencilKernels* const kernels : all_kernels())
            EXPECT_EQ(kernels->touched(boxes, query), truth);
    }
}

}  // namespace
}  // namespace caustics::beamtree
