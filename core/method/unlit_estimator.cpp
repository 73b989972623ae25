#include "core/method/unlit_estimator.h"

#include <stdexcept>
#include <utility>

namespace caustics {
namespace {

[[noreturn]] void refuse() { throw std::logic_error("a method's least work brings no light"); }

}  // namespace

UnlitEstimator::UnlitEstimator(BuildReport report) : report_(std::move(report)) {}

void UnlitEstimator::radiance(std::span<const ReceiverPoint>, std::span<Estimate>,
                              QueryContext&) const {
    refuse();
}

void UnlitEstimator::irradiance(std::span<const ReceiverPoint>, std::span<Estimate>,
                                QueryContext&) const {
    refuse();
}

}  // namespace caustics
