#include "photonmap/photon_dots.h"

#include <bit>
#include <cmath>

#include "photonmap/photons/rgbe.h"
#include "photonmap/tree/build_tree.h"

namespace caustics::photonmap {

namespace {

struct DotScratch final : QueryContext {
    GatherScratch gather;
};

class PhotonDots final : public CausticEstimator {
public:
    PhotonDots(const Scene& scene, TracedPhotons photons, double radius, Isa isa)
        : flux_per_energy_(photons.flux_per_energy()),
          tree_(build_tree(TreeKind::packed, std::move(photons.store), isa)),
          eye_(scene.camera().position()),
          radius_at_one_(radius * std::sqrt(scene.camera().pixel_area())) {}

    std::unique_ptr<QueryContext> make_context() const override {
        return std::make_unique<DotScratch>();
    }

    void radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                  QueryContext& context) const override {
        auto& scratch = dynamic_cast<DotScratch&>(context).gather;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto distance = static_cast<double>((points[i].position - eye_).norm());
            const GatherLimits limits{GatherLimits::all,
                                      static_cast<float>(radius_at_one_ * distance)};
            tree_->gather(points.subspan(i, 1), limits, scratch,
                          [&](std::size_t, const GatheredPhotons& found) {
                              out[i] = {brightness(found), black()};
                          });
        }
    }
    void irradiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                    QueryContext& context) const override {
        radiance(points, out, context);
    }

private:
    Spectrum brightness(const GatheredPhotons& found) const {
        Spectrum sum = black();
        for (std::size_t i = 0; i < found.count; ++i)
            sum += decode_rgbe(std::bit_cast<Rgbe>(found.energy[i]));
        sum *= flux_per_energy_;
        const float largest = sum.maxCoeff();
        if (!(largest > 0)) return black();
        return sum / largest * (1 + std::log2(static_cast<float>(found.count)));
    }

    Spectrum flux_per_energy_;
    std::unique_ptr<const PhotonTree> tree_;
    Vec3 eye_;
    double radius_at_one_;  ///< [m] of a dot at distance 1 m
};

}  // namespace

std::unique_ptr<const CausticEstimator> photon_dots(const Scene& scene, TracedPhotons photons,
                                                    double radius, Isa isa) {
    return std::make_unique<PhotonDots>(scene, std::move(photons), radius, isa);
}

}  // namespace caustics::photonmap
