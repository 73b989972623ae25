#include "beamtree/sampled_beams.h"

#include <stdexcept>

#include "beamtree/tracing/scene_sample.h"

namespace caustics::beamtree {
namespace {

class SampledBeams final : public CausticEstimator {
public:
    explicit SampledBeams(BuildReport report) : report_(std::move(report)) {}

    void radiance(std::span<const ReceiverPoint>, std::span<Estimate>,
                  QueryContext&) const override {
        refuse();
    }
    void irradiance(std::span<const ReceiverPoint>, std::span<Estimate>,
                    QueryContext&) const override {
        refuse();
    }
    BuildReport build_report() const override { return report_; }

private:
    [[noreturn]] static void refuse() {
        throw std::logic_error("a sample of the beams brings no light");
    }

    BuildReport report_;
};

}  // namespace

std::unique_ptr<const CausticEstimator> sampled_beams(const Scene& scene, const std::string& method,
                                                      const BeamParams& params,
                                                      const RunOptions& options) {
    options.phase("beams");
    return std::make_unique<SampledBeams>(sample_scene(scene, method, params, options).report());
}

}  // namespace caustics::beamtree
