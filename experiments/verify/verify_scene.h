#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene_reader.h"
#include "experiments/verify/agreement.h"
#include "experiments/verify/more_work.h"

namespace caustics::experiments {

/// One thing that was checked, or told (no verdict: nothing that could fail).
struct Finding {
    std::string what;
    std::optional<Agreement> verdict;
    std::string detail;
};

/// All that `verify SCENE` found.
struct SceneReport {
    std::vector<Finding> findings;

    /// Everything holds, or, where that is allowed, converges.
    bool holds(bool allow_converging = false) const;
    std::string text() const;  ///< one line a finding
};

/// How `verify SCENE` asks.
struct VerifySettings {
    /// Methods with the parameters that were given; empty: all that have a caustic, at their defaults.
    std::vector<MethodAsGiven> methods;
    RunOptions run;
    /// Seconds that the pictures of one method may take at one setting, beyond the least number of them.
    double seconds = 60;
};

/// Checks a scene with small pictures, at most 48 pixels wide:
///   * each light's account (light_audit.h);
///   * each method's picture, bit for bit the same with one thread, two, and as many as the settings have;
///   * each method against an unbiased reference, in the whole picture and in 6 x 4 cells (cell_light.h), over
///     twelve seeds or more. It *holds* if the whole is within 2 % and within five standard errors of the
///     difference and each cell within 9.8 %, *converges* if not but 4 and 16 times the work make the difference
///     smaller (agreement.h), is *unsure* if the standard error of the difference exceeds 0.4 % (of a cell 2 %)
///     when the time is over, and else *fails*;
///   * that light comes from a light by casters to a place that the camera sees, and where it ends if not.
/// Throws UnsupportedScene where a method that is named cannot serve the scene.
SceneReport verify_scene(SceneFile file, const VerifySettings& settings);

}  // namespace caustics::experiments
