#pragma once

#include "core/caustic_estimator.h"

namespace caustics {

/// What a method's least work leaves behind where it was only asked whether it can serve a scene: a report, and no
/// light. Asked for light it throws std::logic_error.
class UnlitEstimator final : public CausticEstimator {
public:
    explicit UnlitEstimator(BuildReport report = {});

    void radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                  QueryContext& context) const override;
    void irradiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                    QueryContext& context) const override;
    BuildReport build_report() const override { return report_; }

private:
    BuildReport report_;
};

}  // namespace caustics
