#pragma once

#include <optional>

#include "core/method/method_description.h"
#include "experiments/cli/single_picture.h"
#include "experiments/run/time_budget.h"

namespace caustics::experiments {

/// The picture that lets the whole command take the CPU seconds of `--seconds`: those of loading, of trials, and of
/// writing count.
class PictureInTime {
public:
    /// Loads the scene. Throws InputError where nothing could take the time.
    explicit PictureInTime(const RenderOptions& options);

    /// Throws InputError, with the least that would do, where the time is too short.
    SinglePicture picture();
    /// The scene file of the picture.
    const SceneFile& file() const { return scene_->file(); }

private:
    /// How a search for the work ended.
    enum class Ending {
        filled,
        same,     ///< work makes no difference
        too_much  ///< the least work takes more than is left
    };
    struct Found {
        Ending ending;
        TimeBudget::Plan plan;                      ///< of the picture
        std::optional<SinglePicture> picture = {};  ///< where a trial is the picture
        double seconds = 0;  ///< of the least work, where it takes too much [CPU s]
    };
    Found search(const WorkParameter& work);
    SinglePicture made(const WorkParameter& work, const TimeBudget::Plan& plan);
    void tell(const WorkParameter& work, const TimeBudget::Plan& plan) const;
    SinglePicture told_of_misfit(SinglePicture picture) const;
    double left() const;
    bool has_time_for(double more) const;
    [[noreturn]] void refuse(double more) const;
    std::string least_text(const std::string& least) const;

    RenderOptions options_;
    double seconds_;
    WorkParameter work_;
    std::optional<LoadedScene> scene_;
    double loading_ = 0;      ///< [CPU s]
    double writing_ = 0;      ///< what it will take [CPU s]
    double ending_ = 0;       ///< and what else comes after rendering [CPU s]
    int pixel_step_ = 1;      ///< trials render one of so many pixels
    bool may_refuse_ = true;  ///< nothing is known yet of the least time
    TimeBudget::Cost cost_;   ///< of the last picture
};

}  // namespace caustics::experiments
