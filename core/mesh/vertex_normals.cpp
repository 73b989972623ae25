#include "core/mesh/vertex_normals.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/base/sort_by_number.h"

namespace caustics {
namespace {

struct NormalSum {
    Vec3d weighted = Vec3d::Zero();
    Vec3d first = Vec3d::Zero();  // of the first triangle that is not degenerate
};

// Adds a triangle's normal, weighted by its angles, to its three corners.
void add_triangle(const std::array<Vec3d, 3>& corners, const std::array<NormalSum*, 3>& sums) {
    const Vec3d cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (cross.isZero(0)) return;
    const Vec3d normal = cross.stableNormalized();
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d a = corners[(i + 1) % 3] - corners[i];
        const Vec3d b = corners[(i + 2) % 3] - corners[i];
        sums[i]->weighted += std::atan2(a.cross(b).norm(), a.dot(b)) * normal;
        if (sums[i]->first.isZero(0)) sums[i]->first = normal;
    }
}

// Of a position; adding zero makes -0 and 0 alike.
std::uint32_t hash(const Vec3& position) {
    std::uint32_t hash = 0;
    for (const float x : position)
        hash = (hash ^ std::bit_cast<std::uint32_t>(x + 0.0F)) * 0x9E3779B1U ^ hash >> 15U;
    return hash ^ hash >> 16U;
}

Vec3 direction_of(const NormalSum& sum) {
    // Angles are exact to rounding only: less than this is a sum that cancels, not a direction.
    if (sum.weighted.norm() > 1e-9) return sum.weighted.normalized().cast<float>();
    if (!sum.first.isZero(0)) return sum.first.cast<float>();
    return Vec3::UnitZ();
}

}  // namespace

std::vector<std::uint32_t> number_positions(const std::vector<Vec3>& positions, int threads) {
    const auto key = [&](std::uint32_t vertex) {
        const Vec3& p = positions[vertex];
        return std::tuple(p.x(), p.y(), p.z());
    };
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    const std::size_t count = std::bit_ceil(positions.size() + 1);
    order = sort_by_number(
        std::span<const std::uint32_t>(order), count, threads,
        [&](std::uint32_t vertex) { return hash(positions[vertex]) & (count - 1); },
        [&](std::uint32_t a, std::uint32_t b) {
            return std::tuple(key(a), a) < std::tuple(key(b), b);
        });
    std::vector<std::uint32_t> numbers(positions.size());
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i > 0 && key(order[i - 1]) != key(order[i])) ++number;
        numbers[order[i]] = number;
    }
    return numbers;
}

void complete_normals(TriangleMesh& mesh) {
    mesh.normals.resize(mesh.positions.size(), Vec3::Zero());
    const std::vector<std::uint32_t> numbers = number_positions(mesh.positions);
    std::vector<NormalSum> sums(mesh.positions.size());
    for (const auto& triangle : mesh.triangles) {
        std::array<Vec3d, 3> corners;
        std::array<NormalSum*, 3> corner_sums{};
        for (std::size_t i = 0; i < 3; ++i) {
            corners[i] = mesh.positions[triangle[i]].cast<double>();
            corner_sums[i] = &sums[numbers[triangle[i]]];
        }
        add_triangle(corners, corner_sums);
    }
    for (std::size_t vertex = 0; vertex < mesh.normals.size(); ++vertex) {
        Vec3& normal = mesh.normals[vertex];
        if (normal.isZero(0))
            normal = direction_of(sums[numbers[vertex]]);
        else
            normal = normal.cast<double>().normalized().cast<float>();
    }
}

double largest_bend(const TriangleMesh& mesh) {
    if (mesh.normals.empty()) return 0;
    double cosine = 1;
    for (const auto& triangle : mesh.triangles) {
        const Vec3d a = mesh.positions[triangle[0]].cast<double>();
        const Vec3d cross = (mesh.positions[triangle[1]].cast<double>() - a)
                                .cross(mesh.positions[triangle[2]].cast<double>() - a);
        if (cross.isZero(0)) continue;
        const Vec3d normal = cross.stableNormalized();
        for (const std::uint32_t corner : triangle)
            cosine = std::min(cosine, normal.dot(mesh.normals[corner].cast<double>()));
    }
    return std::acos(std::clamp(cosine, -1.0, 1.0));
}

}  // namespace caustics
