#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>

#include "core/scene/scene.h"
#include "experiments/run/method.h"

namespace caustics::experiments {

/// Time and memory that a picture is foretold to take.
struct PictureCost {
    double seconds = 0;     ///< of all threads, from a loaded scene to the picture's layers [CPU s]
    double bytes = 0;       ///< in memory at most beyond the loaded scene
    bool is_least = false;  ///< trials that did not take too long told too little of more work
};

/// How many times as much work as by default a method's parameters ask for; 1 where that is not known.
double work_over_default(const Method& method);

/// Foretells what pictures of a scene take, by trials that do a small share of the work for some of the pixels. Seconds are
/// those of the machine that it runs on; adaptive samples beyond the first are not among them.
class CostForecast {
public:
    CostForecast(const Scene& scene, int samples_per_pixel);

    /// Foretells each phase of the picture [CPU s], by the names of RunOptions::begin_phase; nothing where trials do not tell.
    /// Throws as the picture would.
    std::map<std::string, double> phases_of(const Method& method) const;
    /// Throws as the picture would: UnsupportedScene, InputError. `polygons`: how many the method's work is done for, one by
    /// one; 0: it is not.
    PictureCost of(const Method& method, std::uint64_t polygons) const;

private:
    struct Trial {
        double share = 0;  ///< of the method's work
        double took = 0;   ///< [CPU s]
        double build =
            0;  ///< of it, to build the method and to find what is told of the picture [CPU s]
        double caustic =
            0;  ///< of it, to render the trial's pixels, beyond what they take without a caustic [CPU s]
        double bytes = 0;
        std::map<std::string, double> phases;  ///< of the build [CPU s]
        bool is_whole = true;                  ///< else given up
    };
    struct Trials {
        Trial before;  ///< the last where there is no other
        Trial last;
        bool are_enough = false;  ///< to tell what all work takes
    };
    /// The value at all work by those of the last two trials.
    static double whole(const Trials& trials, const std::function<double(const Trial&)>& value,
                        double (*curve)(double, double, double, double));
    double caustic_of(const Method& method, const Trials& trials) const;
    /// Renders one of so many pixels.
    Trial trial(const Method& method, double share, int pixel_step) const;
    /// With more and more work.
    Trials trials(const Method& method, std::uint64_t polygons) const;

    const Scene& scene_;
    int samples_per_pixel_;
    int pixel_step_;
    double long_ = std::numeric_limits<double>::infinity();  ///< that a trial takes [CPU s]
    double film_ = 0;  ///< that a rendering takes, however few its pixels are [CPU s]
    double eye_ = 0;   ///< of a trial's pixels without a caustic [CPU s]
};

}  // namespace caustics::experiments
