#include "beamtree/rest/photon_discs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "beamtree/beams/bin_share.h"
#include "beamtree/rest/leaf_heap.h"
#include "core/base/parallel.h"
#include "core/scene/same_surface.h"

namespace caustics::beamtree {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
// So much wider are boxes than the discs in them.
constexpr float rounding = 1.00001F;
// What threads take at a time.
constexpr std::size_t leaves_together = 64;

bool face_alike(const Vec3& normal, const RestPhoton& photon) {
    return photon.normal.dot(normal) > same_surface_cosine && photon.wi.dot(normal) > 0;
}

/// How far from photons their neighbours lie.
class Neighbours {
public:
    /// `boxes` hold the positions of leaves that have equal shares of the photons.
    Neighbours(const std::vector<RestPhoton>& photons, const std::vector<Box>& boxes)
        : photons_(photons), boxes_(boxes), leaves_(boxes.size() / 2) {}

    /// Squared distance of the `nearest`th, or of the farthest where there are fewer; 0 without any. `guess` is one from
    /// nearby, or infinity.
    float squared_distance(std::size_t photon, std::uint32_t nearest, float guess) {
        const float everything = boxes_[1].diagonal().squaredNorm();
        for (float within = guess;; within = within > everything ? infinity : 4 * within) {
            collect(photon, within);
            if (distances_.size() < nearest && within < infinity) continue;
            if (distances_.empty()) return 0;
            const std::size_t last = std::min<std::size_t>(nearest, distances_.size()) - 1;
            const auto at = distances_.begin() + static_cast<std::ptrdiff_t>(last);
            std::nth_element(distances_.begin(), at, distances_.end());
            return *at;
        }
    }

private:
    // Squared distances up to `within`.
    void collect(std::size_t photon, float within) {
        const RestPhoton& own = photons_[photon];
        distances_.clear();
        stack_.assign(1, 1);
        while (!stack_.empty()) {
            const std::size_t node = stack_.back();
            stack_.pop_back();
            if (boxes_[node].squaredExteriorDistance(own.position) > within) continue;
            if (node < leaves_) {
                stack_.push_back(2 * node);
                stack_.push_back(2 * node + 1);
                continue;
            }
            const std::size_t leaf = node - leaves_;
            const std::size_t end = (leaf + 1) * photons_.size() / leaves_;
            for (std::size_t i = leaf * photons_.size() / leaves_; i < end; ++i) {
                const float squared = (photons_[i].position - own.position).squaredNorm();
                if (squared <= within && i != photon && face_alike(own.normal, photons_[i]))
                    distances_.push_back(squared);
            }
        }
    }

    const std::vector<RestPhoton>& photons_;
    const std::vector<Box>& boxes_;
    std::size_t leaves_;
    std::vector<std::size_t> stack_;
    std::vector<float> distances_;
};

}  // namespace

PhotonDiscs::PhotonDiscs(std::vector<RestPhoton> photons, std::uint32_t nearest, int threads)
    : photons_(std::move(photons)) {
    if (photons_.empty()) return;
    leaves_.resize(std::bit_ceil((photons_.size() + leaf_size - 1) / leaf_size));
    sort_into_leaves(photons_, leaves_.size(), threads);
    find_widths(nearest, threads);
    bound_discs();
}

std::uint64_t PhotonDiscs::bytes() const {
    return photons_.size() * sizeof(RestPhoton) + leaves_.size() * sizeof(Leaf) +
           boxes_.size() * sizeof(Box);
}

void PhotonDiscs::find_widths(std::uint32_t nearest, int threads) {
    boxes_ = boxes_of_positions(photons_, leaves_.size());
    parallel_chunks(threads, leaves_.size(), leaves_together, [&](const Chunk& chunk) {
        Neighbours neighbours(photons_, boxes_);
        float guess = infinity;
        for (std::size_t leaf = chunk.first; leaf < chunk.end; ++leaf)
            for (std::size_t i = first_of(leaf); i < first_of(leaf + 1); ++i) {
                Leaf& discs = leaves_[leaf];
                const std::size_t place = i - first_of(leaf);
                const Vec3& position = photons_[i].position;
                discs.x[place] = position.x();
                discs.y[place] = position.y();
                discs.z[place] = position.z();
                const float squared = neighbours.squared_distance(i, nearest, guess);
                discs.squared_radius[place] = squared;
                // A little more, so that mostly one pass finds enough.
                guess = squared > 0 ? 1.5F * squared : infinity;
            }
    });
}

void PhotonDiscs::bound_discs() {
    for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
        Box box;
        for (std::size_t i = first_of(leaf); i < first_of(leaf + 1); ++i) {
            const float squared = leaves_[leaf].squared_radius[i - first_of(leaf)];
            const Vec3 reach = Vec3::Constant(rounding * std::sqrt(squared));
            box.extend(Vec3(photons_[i].position - reach));
            box.extend(Vec3(photons_[i].position + reach));
        }
        boxes_[leaves_.size() + leaf] = box;
    }
    unite(boxes_);
}

template <typename Weight>
void PhotonDiscs::add_leaf(std::size_t leaf, const ReceiverPoint& point, const Weight& weight,
                           SpectrumSum& sum) const {
    const Leaf& discs = leaves_[leaf];
    const Vec3& x = point.position;
    std::array<float, leaf_size> squared;
    for (std::size_t i = 0; i < leaf_size; ++i) {
        const float dx = discs.x[i] - x.x();
        const float dy = discs.y[i] - x.y();
        const float dz = discs.z[i] - x.z();
        squared[i] = dx * dx + dy * dy + dz * dz;
    }
    const std::size_t first = first_of(leaf);
    for (std::size_t i = 0; i < leaf_size; ++i) {
        if (!(squared[i] < discs.squared_radius[i])) continue;
        const RestPhoton& photon = photons_[first + i];
        if (!face_alike(point.geometric_normal, photon)) continue;
        const auto area = static_cast<double>(discs.squared_radius[i]) * pi_d;
        const double kernel =
            2 * (1 - static_cast<double>(squared[i] / discs.squared_radius[i])) / area;
        const Spectrum light = photon.flux * weight(photon.wi) * share_of_bin(photon.bin, point.nm);
        sum += light.cast<double>() * kernel;
    }
}

template <typename Weight>
Spectrum PhotonDiscs::sum(const ReceiverPoint& point, std::vector<std::uint32_t>& stack,
                          const Weight& weight) const {
    SpectrumSum sum = SpectrumSum::Zero();
    if (photons_.empty()) return black();
    for_each_leaf(
        boxes_, stack, [&](const Box& box) { return box.contains(point.position); },
        [&](std::size_t leaf) { add_leaf(leaf, point, weight, sum); });
    return sum.cast<float>();
}

Spectrum PhotonDiscs::irradiance(const ReceiverPoint& point,
                                 std::vector<std::uint32_t>& stack) const {
    return sum(point, stack, [](const Vec3&) { return Spectrum(Spectrum::Ones()); });
}

Spectrum PhotonDiscs::radiance(const ReceiverPoint& point,
                               std::vector<std::uint32_t>& stack) const {
    return sum(point, stack, [&point](const Vec3& wi) {
        return evaluate(*point.bsdf, point.uv, point.shading_normal, point.wo, wi);
    });
}

}  // namespace caustics::beamtree
