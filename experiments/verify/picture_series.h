#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/render/film.h"
#include "core/scene/scene.h"
#include "experiments/base/step_progress.h"
#include "experiments/run/method.h"

namespace caustics::experiments {

/// How many pictures a series has.
struct SeriesLength {
    std::size_t least = 12;
    double seconds =
        60;  ///< Time after which no picture is begun that goes beyond the least number.
};

/// Pictures of a scene by one method that differ by their seeds alone, one seed after the other.
class PictureSeries {
public:
    /// `options` has the first seed. Keeps a reference to the scene.
    PictureSeries(const Scene& scene, Method method, RunOptions options);

    /// Adds pictures until there are `length.least` and excess() is at most 1, or until the time is over. `excess`:
    /// the factor by which the standard error of the series so far is too large. The step's progress never falls.
    void fill(const SeriesLength& length, const std::function<double()>& excess,
              StepProgress& progress);
    /// The layers `caustic` and `unreached` of the pictures.
    const std::vector<Film>& films() const { return films_; }
    std::uint64_t count() const { return films_.size(); }

private:
    void add(StepProgress& progress, double share);

    const Scene& scene_;
    Method method_;
    RunOptions options_;
    std::vector<Film> films_;
};

/// A picture with all its layers. `built` gets the report of the method's first pass.
Film picture_of(const Scene& scene, const Method& method, const RunOptions& options,
                const std::function<void(const BuildReport&)>& built = {});

}  // namespace caustics::experiments
