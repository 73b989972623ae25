#pragma once

#include <cstdint>
#include <optional>

#include "core/method/method_description.h"

namespace caustics::experiments {

/// Finds the work that takes a wanted time, from the times of smaller work. Trials grow until they take a good
/// part of it; then the line through the last two says how much fills it.
class TimeBudget {
public:
    /// How far from the wanted time [share of it] a trial may be to be kept at once.
    static constexpr double tolerance = 0.1;

    TimeBudget(double seconds, const WorkParameter& work);

    /// The work to be tried now.
    std::int64_t work() const { return work_; }
    /// Takes what work() took [s]. Whether more or less is to be tried; if not, work() is what to keep.
    bool goes_on_after(double seconds);

private:
    /// Time grows in proportion to the size, but for a constant.
    struct Trial {
        double size = 0;
        double seconds = 0;
    };
    double next_size(const Trial& trial) const;

    double wanted_;
    WorkParameter parameter_;
    std::int64_t work_;
    std::optional<Trial> last_;
    double spent_ = 0;  ///< by all trials [s]
};

}  // namespace caustics::experiments
