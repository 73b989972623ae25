#pragma once

#include <cstdint>
#include <vector>

#include "core/method/method_description.h"

namespace caustics::experiments {

/// Finds the work with which a picture fills what is left of a time, from the times of trials: pictures of some of the
/// pixels with little work. Trials grow until one tells enough. The line through the last two says how much work the whole
/// picture gets.
class TimeBudget {
public:
    /// How far from the wanted time [share of it] is near enough.
    static constexpr double tolerance = 0.1;

    /// The part of a picture that the work is done for.
    enum class Work {
        of_pixels,  ///< rendering takes its time pixel by pixel
        of_picture  ///< light paths connect to the camera by themselves, however many pixels are asked for
    };
    /// A picture to be made.
    struct Plan {
        std::int64_t work = 1;
        bool is_last = false;  ///< the whole picture, no trial
    };
    struct Cost {
        double build = 0;   ///< and all else that does not grow with the pixels [s]
        double render = 0;  ///< [s]
        double fixed = 0;   ///< whatever the work is [s]
    };

    /// Trials render one of `pixel_step` pixels.
    TimeBudget(const WorkParameter& parameter, Work kind, int pixel_step);

    const Plan& plan() const { return plan_; }
    /// Takes what the trial of plan() cost, and the seconds that are left then; plan() is the next.
    void take(const Cost& cost, double left);
    /// Seconds of the whole picture with the least work.
    double least() const { return trials_.front().whole; }

private:
    struct Trial {
        double size = 0;     ///< that time grows in proportion to, but for a constant
        double seconds = 0;  ///< that it took
        double whole = 0;    ///< seconds of the whole picture with its work
        double fixed = 0;    ///< of these, whatever the work is
        double render = 0;   ///< of these, rendering
    };
    double size_that_takes(double seconds, double Trial::* cost) const;
    double size_of_next_trial(double left) const;
    double size_of_picture(double left) const;
    double size_by_one_trial(double left) const;
    bool is_enough(double left) const;
    void plan_of(double size, bool is_last);

    WorkParameter parameter_;
    Work kind_;
    int pixel_step_;
    Plan plan_;
    std::vector<Trial> trials_;
    double first_size_;
    double first_render_ = 0;  ///< of the first trial [s]
};

}  // namespace caustics::experiments
