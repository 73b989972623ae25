#include "beamtree/pencils/pencil_map.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "beamtree/beams/bin_share.h"
#include "beamtree/pencils/pencil_leaf.h"
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
// Doublings of that number for lamps with area, whose prints overlap anyway: one for each doubling of the light's density over its mean.
// Errors weigh most there, and few points are there.
constexpr int most_doublings = 9;
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

void put(float (&rows)[3][pencil_width], std::size_t i, const Vec3& v) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) rows[axis][i] = v[axis];
}

Vec3 get(const float (&rows)[3][pencil_width], std::size_t i) {
    return {rows[0][i], rows[1][i], rows[2][i]};
}

PencilLeaf empty_leaf() {
    PencilLeaf leaf{};
    std::ranges::fill(leaf.height, -1.0F);
    std::ranges::fill(leaf.area, 1.0F);
    return leaf;
}

// Puts a print into a leaf; returns its box.
Box place(PencilLeaf& leaf, std::size_t k, const PencilPrint& print) {
    const Vec3d wi = print.wi.cast<double>().normalized();
    const auto [a, b] =
        widened({across_ray(print.sides[0], wi), across_ray(print.sides[1], wi)}, wi);
    const double turn = wi.dot(a.cross(b));
    const float size = std::max(print.sides[0].norm(), print.sides[1].norm());
    const float height = (print.flat ? height_of_flat : height_over_size) * size +
                         8 * rounding_offset(print.position);
    put(leaf.position, k, print.position);
    put(leaf.normal, k, print.normal);
    put(leaf.wi, k, print.wi);
    put(leaf.flux, k, print.flux);
    leaf.light[k] = print.light;
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

}  // namespace

const PencilKernels& pencil_kernels([[maybe_unused]] Isa isa) {
#ifdef CAUSTICS_X86_KERNELS
    if (isa == Isa::avx512) return avx512_pencil_kernels();
    if (isa == Isa::avx2) return avx2_pencil_kernels();
#endif
    return plain_pencil_kernels();
}

PencilQuery pencil_query(const ReceiverPoint& point) {
    PencilQuery query{};
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        query.position[axis] = point.position[axis];
        query.normal[axis] = point.geometric_normal[axis];
    }
    if (point.cell == nullptr) return query;
    const auto& corners = point.cell->corners;
    const Vec2d across = corners[2] - corners[0], along = corners[3] - corners[1];
    const double area = std::abs(across.x() * along.y() - across.y() * along.x()) / 2;
    if (!(area > 0)) return query;
    query.over_area = 1 / area;
    query.radius = static_cast<float>(point.cell->radius);
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 corner = point.cell->corner(i).cast<float>();
        for (Eigen::Index axis = 0; axis < 3; ++axis) query.corner[i][axis] = corner[axis];
    }
    return query;
}

PencilMap::PencilMap(std::vector<PencilPrint> prints, std::span<const LightSample> lights, Isa isa,
                     int threads)
    : kernels_(&pencil_kernels(isa)), count_(prints.size()) {
    for (const LightSample& light : lights) bins_.push_back(light.bin);
    if (prints.empty()) return;
    leaves_.resize(std::bit_ceil((count_ + pencil_width - 1) / pencil_width));
    sort_into_leaves(prints, leaves_.size(), threads);
    shorten_prints(prints, lights, threads);
    place_prints(prints, threads);
}

std::uint64_t PencilMap::bytes() const {
    return leaves_.size() * sizeof(PencilLeaf) + boxes_.size() * sizeof(PencilBoxes);
}

void PencilMap::shorten_prints(std::vector<PencilPrint>& prints,
                               std::span<const LightSample> lights, int threads) const {
    const std::vector<Box> around = boxes_of_positions(prints, leaves_.size());
    const auto square = [&](std::size_t node) {
        return static_cast<double>(around[node].diagonal().squaredNorm());
    };
    constexpr int levels = std::countr_zero(most_over_a_point / pencil_width);
    const std::size_t nodes = std::max<std::size_t>(1, leaves_.size() >> levels);
    double mean = 0;
    for (std::size_t node = nodes; node < 2 * nodes; ++node)
        mean += square(node) / static_cast<double>(nodes);
    parallel_chunks(threads, leaves_.size(), leaves_of_chunk, [&](const Chunk& chunk) {
        for (std::size_t leaf = chunk.first; leaf < chunk.end; ++leaf) {
            std::size_t node = std::max<std::size_t>(1, (leaves_.size() + leaf) >> levels);
            const float longest = around[node].diagonal().norm();
            double room = mean / (2 * square(node));
            for (int up = 0; up < most_doublings && node > 1 && room > 1; ++up, room /= 2)
                node >>= 1;
            const float longest_of_lamp = around[node].diagonal().norm();
            for (std::size_t i = first_of(leaf); i < first_of(leaf + 1); ++i) {
                const bool is_of_lamp = lights[prints[i].light].kind == LightSample::Kind::area;
                const float most = is_of_lamp ? longest_of_lamp : longest;
                for (Vec3& side : prints[i].sides)
                    if (const float length = side.norm(); most > 0 && length > most)
                        side *= most / length;
            }
        }
    });
}

void PencilMap::place_prints(const std::vector<PencilPrint>& prints, int threads) {
    std::vector<Box> boxes(2 * leaves_.size());
    parallel_chunks(threads, leaves_.size(), leaves_of_chunk, [&](const Chunk& chunk) {
        for (std::size_t leaf = chunk.first; leaf < chunk.end; ++leaf) {
            leaves_[leaf] = empty_leaf();
            for (std::size_t i = first_of(leaf); i < first_of(leaf + 1); ++i)
                boxes[leaves_.size() + leaf].extend(
                    place(leaves_[leaf], i - first_of(leaf), prints[i]));
        }
    });
    unite(boxes);
    // Every third level has boxes, counted from the leaves.
    top_ = std::size_t{1} << (static_cast<unsigned>(std::bit_width(leaves_.size()) - 1) % 3);
    boxes_.resize(leaves_.size() / pencil_width * 2);
    for (std::size_t node = top_; node < leaves_.size(); node *= pencil_width)
        for (std::size_t i = node; i < 2 * node; ++i)
            for (std::size_t k = 0; k < pencil_width; ++k) {
                const Box& box = boxes[pencil_width * i + k];
                put(boxes_[i].low, k, box.min());
                put(boxes_[i].high, k, box.max());
            }
}

template <typename Take>
void PencilMap::for_each_touched(const PencilQuery& query, std::vector<std::uint32_t>& stack,
                                 const Take& take) const {
    // The last first, so that leaves come in their order.
    const auto push = [&](std::size_t node) { stack.push_back(static_cast<std::uint32_t>(node)); };
    stack.clear();
    for (std::size_t node = 2 * top_; node-- > top_;) push(node);
    while (!stack.empty()) {
        const std::size_t node = stack.back();
        stack.pop_back();
        if (node >= leaves_.size()) {
            take(leaves_[node - leaves_.size()]);
            continue;
        }
        std::uint32_t touched = kernels_->touched(boxes_[node], query);
        while (touched != 0) {
            const auto last = static_cast<std::uint32_t>(std::bit_width(touched)) - 1;
            push(pencil_width * node + last);
            touched ^= 1U << last;
        }
    }
}

template <typename Weight>
Spectrum PencilMap::sum(const ReceiverPoint& point, std::vector<std::uint32_t>& stack,
                        const Weight& weight) const {
    if (count_ == 0) return black();
    const PencilQuery query = pencil_query(point);
    SpectrumSum sum = SpectrumSum::Zero();
    alignas(64) double density[pencil_width];
    for_each_touched(query, stack, [&](const PencilLeaf& leaf) {
        if (!kernels_->densities(leaf, query, density)) return;
        for (std::size_t i = 0; i < pencil_width; ++i) {
            if (!(density[i] > 0)) continue;
            const Spectrum light = get(leaf.flux, i).array() * weight(get(leaf.wi, i)) *
                                   share_of_bin(bins_[leaf.light[i]], point.nm);
            sum += light.cast<double>() * density[i];
        }
    });
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
