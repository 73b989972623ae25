#pragma once

#include <memory>
#include <vector>

#include "photon_sets.h"
#include "photonmap/estimate/radiance_estimate.h"
#include "photonmap/tree/build_tree.h"

namespace caustics::photonmap::test {

inline const Bsdf white{Diffuse{Spectrum(Spectrum::Ones())}};

/// A white point of a floor, seen from above.
inline ReceiverPoint floor_point(const Vec3& x) {
    ReceiverPoint point;
    point.position = x;
    point.geometric_normal = point.shading_normal = point.wo = Vec3::UnitZ();
    point.uv = Vec2::Zero();
    point.bsdf = &white;
    return point;
}

/// A tree of photons and estimates over it.
class EstimateMap {
public:
    using Settings = RadianceEstimate::Settings;

    explicit EstimateMap(const std::vector<Photon>& photons, Isa isa = widest_isa(),
                         TreeKind kind = TreeKind::packed)
        : tree_(build_tree(kind, store_of(photons), isa)), isa_(isa) {}

    Spectrum radiance(const Settings& settings, const ReceiverPoint& point) const {
        return evaluated(settings, {point}, &RadianceEstimate::radiance)[0];
    }
    Spectrum irradiance(const Settings& settings, const ReceiverPoint& point) const {
        return irradiance(settings, std::vector{point})[0];
    }
    std::vector<Spectrum> irradiance(const Settings& settings,
                                     const std::vector<ReceiverPoint>& points) const {
        return evaluated(settings, points, &RadianceEstimate::irradiance);
    }
    std::size_t count(const Settings& settings, const ReceiverPoint& point) const {
        std::size_t count = 0;
        GatherScratch scratch;
        tree_->gather({&point, 1}, settings.limits, scratch,
                      [&](std::size_t, const GatheredPhotons& found) { count = found.count; });
        return count;
    }

private:
    using Value = Spectrum (RadianceEstimate::*)(const ReceiverPoint&, const GatheredPhotons&,
                                                 EstimateScratch&) const;
    std::vector<Spectrum> evaluated(const Settings& settings,
                                    const std::vector<ReceiverPoint>& points, Value value) const {
        const RadianceEstimate estimate(settings, isa_);
        std::vector<Spectrum> results(points.size());
        GatherScratch gather;
        EstimateScratch scratch;
        tree_->gather(points, settings.limits, gather,
                      [&](std::size_t i, const GatheredPhotons& found) {
                          results[i] = (estimate.*value)(points[i], found, scratch);
                      });
        return results;
    }

    std::unique_ptr<const PhotonTree> tree_;
    Isa isa_;
};

/// `count` photons at random on [0, width] x [0, 1].
inline std::vector<Photon> uniform_field(std::size_t count, std::uint64_t seed, float width = 1) {
    Rng rng(seed, Stage::test, 0);
    std::vector<Photon> photons;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = rng.next(), y = rng.next();
        photons.push_back(photon_at({width * x, y, 0}));
    }
    return photons;
}

/// side x side points in the middles of the cells of the unit square.
inline std::vector<ReceiverPoint> square_grid(int side) {
    std::vector<ReceiverPoint> points;
    const auto middle = [side](int i) {
        return (static_cast<float>(i) + 0.5F) / static_cast<float>(side);
    };
    for (int i = 0; i < side * side; ++i)
        points.push_back(floor_point({middle(i % side), middle(i / side), 0}));
    return points;
}

}  // namespace caustics::photonmap::test
