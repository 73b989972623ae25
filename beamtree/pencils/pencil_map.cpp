#include "beamtree/pencils/pencil_map.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "beamtree/beams/bin_share.h"
#include "beamtree/rest/leaf_heap.h"
#include "core/base/parallel.h"
#include "core/geometry/surface_offset.h"

namespace caustics::beamtree {
namespace {

// A print's width is at least this share of its length: those of folds lie on lines.
constexpr double thinnest = 1e-3;
// How far off its plane a print's rays count, over its size: a rough surface lies there, a flat one but for rounding not.
constexpr float height_over_size = 0.5F;
constexpr float height_of_flat = 1e-3F;
// So much wider are boxes than the prints in them.
constexpr float wider_box = 1e-5F;
// A side of a print is at most as long as the box of so many prints about it. More prints over a point cost time and gain little.
constexpr std::size_t most_over_a_point = 64;
// Where light is denser than on average, so many times twice as many: there errors weigh most, and few points ask.
constexpr int most_doublings = 6;
// Leaves that a thread takes at a time.
constexpr std::size_t leaves_of_chunk = 64;

// Sides of a parallelogram across a unit direction: at least so wide, across the longer one.
std::array<Vec3d, 2> widened(std::array<Vec3d, 2> sides, const Vec3d& normal) {
    if (sides[1].squaredNorm() > sides[0].squaredNorm()) {
        std::array<Vec3d, 2> turned = widened({sides[1], sides[0]}, normal);
        return {turned[1], turned[0]};
    }
    const double length = sides[0].norm();
    const Vec3d across = normal.cross(sides[0]) / length;
    const double width = sides[1].dot(across);
    const double least = thinnest * length;
    if (std::abs(width) < least) sides[1] += (std::copysign(least, width) - width) * across;
    return sides;
}

Vec3d across_ray(const Vec3& side, const Vec3d& wi) {
    const Vec3d way = side.cast<double>();
    return way - way.dot(wi) * wi;
}

void put(std::array<std::array<float, 8>, 3>& row, std::size_t i, const Vec3& v) {
    for (std::size_t axis = 0; axis < 3; ++axis) row[axis][i] = v[static_cast<Eigen::Index>(axis)];
}

Vec3 get(const std::array<std::array<float, 8>, 3>& row, std::size_t i) {
    return {row[0][i], row[1][i], row[2][i]};
}

}  // namespace

PencilMap::PencilMap(std::vector<PencilPrint> prints, std::span<const LightSample> lights,
                     int threads)
    : prints_(std::move(prints)) {
    for (const LightSample& light : lights) bins_.push_back(light.bin);
    if (prints_.empty()) return;
    leaves_.resize(std::bit_ceil((prints_.size() + leaf_size - 1) / leaf_size));
    sort_into_leaves(prints_, leaves_.size(), threads);
    shorten_prints(threads);
    place_prints(threads);
}

std::uint64_t PencilMap::bytes() const {
    return prints_.size() * sizeof(PencilPrint) + leaves_.size() * sizeof(Leaf) +
           boxes_.size() * sizeof(Box);
}

void PencilMap::shorten_prints(int threads) {
    const std::vector<Box> around = boxes_of_positions(prints_, leaves_.size());
    constexpr int levels = std::countr_zero(most_over_a_point / leaf_size);
    const std::size_t nodes = std::max<std::size_t>(1, leaves_.size() >> levels);
    double mean = 0;
    for (std::size_t node = nodes; node < 2 * nodes; ++node)
        mean +=
            static_cast<double>(around[node].diagonal().squaredNorm()) / static_cast<double>(nodes);
    parallel_chunks(threads, leaves_.size(), leaves_of_chunk, [&](const Chunk& chunk) {
        for (std::size_t leaf = chunk.first; leaf < chunk.end; ++leaf) {
            std::size_t node = std::max<std::size_t>(1, (leaves_.size() + leaf) >> levels);
            double room = mean / static_cast<double>(2 * around[node].diagonal().squaredNorm());
            for (int up = 0; up < most_doublings && node > 1 && room > 1; ++up, room /= 2)
                node >>= 1;
            const float longest = around[node].diagonal().norm();
            for (std::size_t i = first_of(leaf); i < first_of(leaf + 1); ++i)
                for (Vec3& side : prints_[i].sides)
                    if (const float length = side.norm(); longest > 0 && length > longest)
                        side *= longest / length;
        }
    });
}

void PencilMap::place_prints(int threads) {
    boxes_.resize(2 * leaves_.size());
    parallel_chunks(threads, leaves_.size(), leaves_of_chunk, [&](const Chunk& chunk) {
        for (std::size_t leaf = chunk.first; leaf < chunk.end; ++leaf) {
            leaves_[leaf].height.fill(-1);
            for (std::size_t i = first_of(leaf); i < first_of(leaf + 1); ++i)
                boxes_[leaves_.size() + leaf].extend(
                    place(leaves_[leaf], i - first_of(leaf), prints_[i]));
        }
    });
    unite(boxes_);
}

// Puts a print into a leaf; returns its box.
Box PencilMap::place(Leaf& leaf, std::size_t k, const PencilPrint& print) {
    const Vec3d wi = print.wi.cast<double>().normalized();
    const auto [a, b] =
        widened({across_ray(print.sides[0], wi), across_ray(print.sides[1], wi)}, wi);
    const double turn = wi.dot(a.cross(b));
    const float size = std::max(print.sides[0].norm(), print.sides[1].norm());
    const float height = (print.flat ? height_of_flat : height_over_size) * size +
                         8 * rounding_offset(print.position);
    put(leaf.position, k, print.position);
    put(leaf.normal, k, print.normal);
    const std::array<Vec3d, 2> by_side = {b.cross(wi) / turn, wi.cross(a) / turn};
    for (std::size_t i = 0; i < 2; ++i) {
        put(leaf.by_side[i], k, by_side[i].cast<float>());
        leaf.by_metre[i][k] = static_cast<float>(by_side[i].norm());
    }
    leaf.height[k] = height;
    leaf.area[k] = static_cast<float>(std::abs(turn));
    // Sides on the plane, of a print that may have been widened, and what rays pass beside it up to the height.
    const Vec3d normal = print.normal.cast<double>();
    const double cosine = normal.dot(wi);
    const auto on_plane = [&](const Vec3d& side) -> Vec3d {
        return (side - normal.dot(side) / cosine * wi).cwiseAbs();
    };
    const Vec3 reach =
        ((on_plane(a) + on_plane(b)) / 2 + static_cast<double>(height) / cosine * wi.cwiseAbs())
            .cast<float>();
    const Vec3 wider = reach + Vec3::Constant(wider_box * reach.norm());
    return {print.position - wider, print.position + wider};
}

template <typename Weight>
void PencilMap::add_leaf(std::size_t leaf, const ReceiverPoint& point, const PencilWindow& window,
                         const Weight& weight, SpectrumSum& sum) const {
    const Leaf& at = leaves_[leaf];
    const Vec3& x = point.position;
    const float radius = window.radius();
    Leaf::Row u, v, room;
    for (std::size_t i = 0; i < leaf_size; ++i) {
        const float dx = x.x() - at.position[0][i];
        const float dy = x.y() - at.position[1][i];
        const float dz = x.z() - at.position[2][i];
        const auto along = [&](const std::array<Leaf::Row, 3>& way) {
            return way[0][i] * dx + way[1][i] * dy + way[2][i] * dz;
        };
        u[i] = along(at.by_side[0]);
        v[i] = along(at.by_side[1]);
        const float off_u = 0.5F + radius * at.by_metre[0][i] - std::abs(u[i]);
        const float off_v = 0.5F + radius * at.by_metre[1][i] - std::abs(v[i]);
        const float off_plane = at.height[i] - std::abs(along(at.normal));
        const float beside = off_u < off_v ? off_u : off_v;
        room[i] = beside < off_plane ? beside : off_plane;
    }
    for (std::size_t i = 0; i < leaf_size; ++i) {
        if (!(room[i] >= 0)) continue;
        const PencilPrint& print = prints_[first_of(leaf) + i];
        const float cosine = print.wi.dot(point.geometric_normal);
        if (!(cosine > 0)) continue;
        const double density =
            window.density({u[i], v[i]}, {get(at.by_side[0], i), get(at.by_side[1], i)},
                           static_cast<double>(at.area[i]), static_cast<double>(cosine));
        if (!(density > 0)) continue;
        const Spectrum light =
            print.flux * weight(print.wi) * share_of_bin(bins_[print.light], point.nm);
        sum += light.cast<double>() * density;
    }
}

template <typename Weight>
Spectrum PencilMap::sum(const ReceiverPoint& point, std::vector<std::uint32_t>& stack,
                        const Weight& weight) const {
    SpectrumSum sum = SpectrumSum::Zero();
    if (prints_.empty()) return black();
    const PencilWindow window(point);
    for_each_leaf(
        boxes_, stack, [&](const Box& box) { return window.may_touch(box); },
        [&](std::size_t leaf) { add_leaf(leaf, point, window, weight, sum); });
    return sum.cast<float>();
}

Spectrum PencilMap::irradiance(const ReceiverPoint& point,
                               std::vector<std::uint32_t>& stack) const {
    return sum(point, stack, [](const Vec3&) { return Spectrum(Spectrum::Ones()); });
}

Spectrum PencilMap::radiance(const ReceiverPoint& point, std::vector<std::uint32_t>& stack) const {
    const Bsdf bsdf = bsdf_at(*point.bsdf, point.uv);
    return sum(point, stack, [&](const Vec3& wi) {
        return evaluate(bsdf, point.uv, point.shading_normal, point.wo, wi);
    });
}

}  // namespace caustics::beamtree
