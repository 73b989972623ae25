#pragma once

#include <cstddef>
#include <cstdint>

#include "core/point_estimator.h"

namespace caustics {

/// What is known beforehand of the lights that a point sees, so that shadow rays can be spared.
class KnownShadows {
public:
    enum class Seen { yes, no, unknown };

    virtual ~KnownShadows() = default;
    /// Whether the point, which faces that light of the scene, sees all of it or nothing. Thread-safe;
    /// `context` is one of the estimator that knows.
    virtual Seen sees(const ReceiverPoint& point, std::size_t light,
                      QueryContext& context) const = 0;
};

/// The shadow rays of an eye-pass thread.
struct ShadowRays {
    const KnownShadows* known = nullptr;  ///< none: every ray is traced
    QueryContext* context = nullptr;
    std::uint64_t traced = 0;
    std::uint64_t spared = 0;
};

}  // namespace caustics
