#include "core/mesh/mesh_doctor.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "core/base/sort_by_number.h"
#include "core/mesh/vertex_normals.h"

namespace caustics {
namespace {

constexpr std::uint32_t no_part = ~0U;

using Triangle = std::array<std::uint32_t, 3>;

/// Sets whose members have one of two sides each.
class SidedSets {
public:
    struct Member {
        std::uint32_t set;
        bool side;
    };

    explicit SidedSets(std::size_t count) : parent_(count), side_(count) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    Member find(std::uint32_t item) {
        bool side = false;
        while (parent_[item] != item) {
            // Path halving: past the parent, to its own.
            const std::uint32_t parent = parent_[item];
            side_[item] = side_[item] ^ side_[parent];
            parent_[item] = parent_[parent];
            side = side != (side_[item] != 0);
            item = parent_[item];
        }
        return {item, side};
    }

    /// Joins the sets of two members, on the same side or not. False if they are in one set, on the wrong sides.
    bool join(std::uint32_t a, std::uint32_t b, bool same_side) {
        const Member x = find(a);
        const Member y = find(b);
        const bool differ = (x.side != y.side) == same_side;
        if (x.set == y.set) return !differ;
        const auto [low, high] = std::minmax(x.set, y.set);
        parent_[high] = low;
        side_[high] = differ ? 1 : 0;
        return true;
    }

private:
    std::vector<std::uint32_t> parent_;
    std::vector<std::uint8_t> side_;  // other than the parent's
};

/// A side of a triangle.
struct Edge {
    std::uint32_t low, high;  // positions
    std::uint32_t triangle;
    bool upwards;

    bool joins(const Edge& other) const { return low == other.low && high == other.high; }
};

/// A part as it is found; `side` of a triangle is 0 or 1, and the two sides face opposite ways.
struct Part {
    std::size_t triangles[2] = {0, 0};
    double area[2] = {0, 0};
    Vec3d area_vector = Vec3d::Zero();  // as if all faced as side 0
    double volume = 0;                  // the same
    Eigen::AlignedBox3d box;
    bool is_open = false;
    bool is_one_sided = false;
    bool is_cavity = false;

    double whole_area() const { return area[0] + area[1]; }
    bool encloses_volume() const {
        constexpr double thinnest = 1e-6;
        return std::abs(volume) > thinnest * std::pow(whole_area(), 1.5);
    }
    bool is_closed() const { return !is_open && !is_one_sided && encloses_volume(); }
    bool is_hollow() const {
        constexpr double of_sheets = 0.25;
        return is_open && !is_one_sided && area_vector.norm() < of_sheets * whole_area();
    }
    /// The side whose triangles face the right way.
    int right_side() const {
        if (!is_closed()) return area[1] > area[0] ? 1 : 0;
        return (volume < 0) != is_cavity ? 1 : 0;
    }
};

/// The solid angle of a triangle seen from a point, signed, by van Oosterom and Strackee (1983), halved.
double half_solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const double p = a.norm(), q = b.norm(), r = c.norm();
    return std::atan2(a.dot(b.cross(c)), p * q * r + a.dot(b) * r + b.dot(c) * p + c.dot(a) * q);
}

class Examination {
public:
    explicit Examination(const TriangleMesh& mesh)
        : mesh_(mesh),
          places_(number_positions(mesh.positions)),
          is_left_out_(mesh.triangles.size()),
          sets_(mesh.triangles.size()),
          part_of_(mesh.triangles.size(), no_part) {}

    MeshDiagnosis run() {
        leave_out();
        sort_edges();
        join_triangles();
        measure_parts();
        look_at_edges();
        find_cavities();
        count_parts();
        return std::move(found_);
    }

private:
    Triangle corners(std::uint32_t triangle) const {
        const auto& [a, b, c] = mesh_.triangles[triangle];
        return {places_[a], places_[b], places_[c]};
    }
    Vec3d at(std::uint32_t triangle, std::size_t corner) const {
        return mesh_.positions[mesh_.triangles[triangle][corner]].cast<double>();
    }
    std::uint32_t triangles() const { return static_cast<std::uint32_t>(mesh_.triangles.size()); }

    // Triangles without area, and all but the first of those with the same corners.
    void leave_out() {
        using Item = std::pair<Triangle, std::uint32_t>;
        std::vector<Item> items;
        items.reserve(triangles());
        for (std::uint32_t i = 0; i < triangles(); ++i) {
            Triangle sorted = corners(i);
            std::ranges::sort(sorted);
            is_left_out_[i] = sorted[0] == sorted[1] || sorted[1] == sorted[2];
            if (is_left_out_[i])
                ++found_.without_area;
            else
                items.emplace_back(sorted, i);
        }
        items = sort_by_number(
            std::span<const Item>(items), mesh_.positions.size(), 1,
            [](const Item& item) { return item.first[0]; }, std::less<Item>());
        for (std::size_t i = 1; i < items.size(); ++i) {
            if (items[i].first != items[i - 1].first) continue;
            is_left_out_[items[i].second] = true;
            ++found_.duplicates;
        }
        throw_if_interrupted();
    }

    void sort_edges() {
        edges_.reserve(3 * mesh_.triangles.size());
        for (std::uint32_t i = 0; i < triangles(); ++i) {
            if (is_left_out_[i]) continue;
            const Triangle all = corners(i);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = all[k], b = all[(k + 1) % 3];
                edges_.push_back({std::min(a, b), std::max(a, b), i, a < b});
            }
        }
        edges_ = sort_by_number(
            std::span<const Edge>(edges_), mesh_.positions.size(), 1,
            [](const Edge& edge) { return edge.low; },
            [](const Edge& a, const Edge& b) {
                return std::tie(a.high, a.triangle) < std::tie(b.high, b.triangle);
            });
        throw_if_interrupted();
    }

    // Calls `visit` with the sides that lie on each edge.
    template <class Visit>
    void for_each_edge(const Visit& visit) const {
        for (std::size_t i = 0, next = 0; i < edges_.size(); i = next) {
            while (next < edges_.size() && edges_[next].joins(edges_[i])) ++next;
            visit(std::span(edges_).subspan(i, next - i));
        }
    }

    void join_triangles() {
        for_each_edge([&](std::span<const Edge> edge) {
            if (edge.size() != 2) return;
            const bool agree = edge[0].upwards != edge[1].upwards;
            if (!sets_.join(edge[0].triangle, edge[1].triangle, agree))
                twisted_.push_back(edge[0].triangle);
        });
    }

    void measure_parts() {
        std::vector<std::uint32_t> part_of_set(mesh_.triangles.size(), no_part);
        for (std::uint32_t i = 0; i < triangles(); ++i) {
            if (is_left_out_[i]) continue;
            const auto [set, side] = sets_.find(i);
            if (part_of_set[set] == no_part) {
                part_of_set[set] = static_cast<std::uint32_t>(parts_.size());
                parts_.emplace_back();
            }
            part_of_[i] = part_of_set[set];
            add(parts_[part_of_[i]], i, side);
        }
        for (const std::uint32_t triangle : twisted_)
            parts_[part_of_[triangle]].is_one_sided = true;
        throw_if_interrupted();
    }

    void add(Part& part, std::uint32_t triangle, bool side) const {
        // From a vertex of the mesh, so that one far away loses no digits.
        const Vec3d origin = mesh_.positions[0].cast<double>();
        const Vec3d a = at(triangle, 0) - origin, b = at(triangle, 1) - origin,
                    c = at(triangle, 2) - origin;
        const Vec3d area = (b - a).cross(c - a) / 2;
        const double sign = side ? -1 : 1;
        ++part.triangles[side];
        part.area[side] += area.norm();
        part.area_vector += sign * area;
        part.volume += sign * a.dot(b.cross(c)) / 6;
        for (const Vec3d& corner : {a, b, c}) part.box.extend(corner);
    }

    void look_at_edges() {
        SidedSets ends(mesh_.positions.size());
        std::vector<std::uint32_t> of_holes;
        std::vector<std::uint32_t> own;
        for_each_edge([&](std::span<const Edge> edge) {
            if (edge.size() == 2) return;
            if (edge.size() == 1) {
                ++found_.open_edges;
                ends.join(edge[0].low, edge[0].high, true);
                of_holes.push_back(edge[0].low);
            } else {
                ++found_.crowded_edges;
            }
            own.clear();
            for (const Edge& side : edge) own.push_back(part_of_[side.triangle]);
            std::ranges::sort(own);
            // A part that an odd number of times ends at an edge does not go on beyond it.
            for (std::size_t i = 0, next = 0; i < own.size(); i = next) {
                while (next < own.size() && own[next] == own[i]) ++next;
                if ((next - i) % 2 == 1) parts_[own[i]].is_open = true;
            }
        });
        for (std::uint32_t& place : of_holes) place = ends.find(place).set;
        std::ranges::sort(of_holes);
        const auto end = std::unique(of_holes.begin(), of_holes.end());
        found_.holes = static_cast<std::size_t>(end - of_holes.begin());
        throw_if_interrupted();
    }

    // Closed parts with a box that holds another one's, the largest first.
    void find_cavities() {
        std::vector<std::uint32_t> closed;
        for (std::uint32_t i = 0; i < parts_.size(); ++i)
            if (parts_[i].is_closed()) closed.push_back(i);
        if (closed.size() < 2) return;
        const auto size = [&](std::uint32_t part) { return parts_[part].box.diagonal().norm(); };
        std::ranges::stable_sort(closed, std::ranges::greater(), size);
        group_triangles();
        constexpr std::size_t most_holders = 100;
        std::vector<std::uint8_t> depth(closed.size());
        for (std::size_t i = 0; i < std::min(closed.size(), most_holders); ++i)
            for (std::size_t j = i + 1; j < closed.size(); ++j)
                if (parts_[closed[i]].box.contains(parts_[closed[j]].box) &&
                    lies_inside(closed[j], closed[i]))
                    depth[j] ^= 1;
        for (std::size_t j = 0; j < closed.size(); ++j) parts_[closed[j]].is_cavity = depth[j] != 0;
    }

    // The triangles of each part, one part after the other.
    void group_triangles() {
        std::vector<std::uint32_t> all;
        for (std::uint32_t i = 0; i < triangles(); ++i)
            if (part_of_[i] != no_part) all.push_back(i);
        grouped_ = sort_by_number(
            std::span<const std::uint32_t>(all), parts_.size(), 1,
            [&](std::uint32_t triangle) { return part_of_[triangle]; }, std::less<std::uint32_t>());
        first_.assign(parts_.size() + 1, 0);
        for (const std::uint32_t triangle : grouped_) ++first_[part_of_[triangle] + 1];
        for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    }

    std::span<const std::uint32_t> triangles_of(std::uint32_t part) const {
        return std::span(grouped_).subspan(first_[part], first_[part + 1] - first_[part]);
    }

    // By some vertices, since parts that cross are none inside the other.
    bool lies_inside(std::uint32_t inner, std::uint32_t outer) {
        constexpr std::size_t asked = 4;
        const auto own = triangles_of(inner);
        for (std::size_t i = 0; i < asked; ++i)
            if (!surrounds(outer, at(own[i * own.size() / asked], i % 3))) return false;
        return true;
    }

    bool surrounds(std::uint32_t part, const Vec3d& point) {
        constexpr std::size_t most_tests = 20'000'000;  // about a second
        double sum = 0;
        for (const std::uint32_t triangle : triangles_of(part)) {
            if (++tests_ > most_tests) return false;
            const double angle = half_solid_angle(at(triangle, 0) - point, at(triangle, 1) - point,
                                                  at(triangle, 2) - point);
            sum += sets_.find(triangle).side ? -angle : angle;
        }
        return std::abs(sum) > pi_d;  // 2 pi inside, 0 outside
    }

    void count_parts() {
        found_.parts = parts_.size();
        for (const Part& part : parts_) {
            found_.closed_parts += part.is_closed() ? 1 : 0;
            found_.cavities += part.is_cavity ? 1 : 0;
            found_.hollow_parts += part.is_hollow() ? 1 : 0;
            found_.one_sided_parts += part.is_one_sided ? 1 : 0;
            if (part.is_one_sided) continue;
            const std::size_t wrong = part.triangles[1 - part.right_side()];
            const bool all = wrong == part.triangles[0] + part.triangles[1];
            if (wrong == 0) continue;
            ++(!all             ? found_.mixed_parts
               : part.is_cavity ? found_.outward_cavities
                                : found_.inside_out_parts);
            if (!all) found_.turned_triangles += wrong;
            if (all && !part.is_cavity) found_.inside_out_triangles += wrong;
        }
        found_.turned.resize(mesh_.triangles.size());
        for (std::uint32_t i = 0; i < triangles(); ++i) {
            if (part_of_[i] == no_part || parts_[part_of_[i]].is_one_sided) continue;
            found_.turned[i] = (sets_.find(i).side ? 1 : 0) != parts_[part_of_[i]].right_side();
        }
    }

    const TriangleMesh& mesh_;
    std::vector<std::uint32_t> places_;  // one a vertex: the number of its position
    std::vector<bool> is_left_out_;
    std::vector<Edge> edges_;  // those of one edge follow each other
    SidedSets sets_;           // of triangles
    std::vector<std::uint32_t> twisted_;
    std::vector<std::uint32_t> part_of_;
    std::vector<Part> parts_;
    std::vector<std::uint32_t> grouped_;
    std::vector<std::size_t> first_;
    std::size_t tests_ = 0;
    MeshDiagnosis found_;
};

// Turns vertex normals that point against the triangles about them.
void turn_normals(TriangleMesh& mesh) {
    if (mesh.normals.empty()) return;
    std::vector<Vec3d> sums(mesh.positions.size(), Vec3d::Zero());
    for (const auto& triangle : mesh.triangles) {
        const Vec3d a = mesh.positions[triangle[0]].cast<double>();
        const Vec3d area = (mesh.positions[triangle[1]].cast<double>() - a)
                               .cross(mesh.positions[triangle[2]].cast<double>() - a);
        for (const std::uint32_t corner : triangle) sums[corner] += area;
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (sums[i].dot(mesh.normals[i].cast<double>()) < 0) mesh.normals[i] = -mesh.normals[i];
}

}  // namespace

MeshDiagnosis diagnose(const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) return {};
    return Examination(mesh).run();
}

void orient(TriangleMesh& mesh) {
    const MeshDiagnosis found = diagnose(mesh);
    if (found.one_sided_parts > 0)
        throw InputError(fmt::format(
            "cannot be oriented: {} of its {} parts, as a Moebius strip, have one side only",
            found.one_sided_parts, found.parts));
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (found.turned[i]) std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
    turn_normals(mesh);
}

}  // namespace caustics
