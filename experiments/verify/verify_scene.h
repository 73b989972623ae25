#pragma once

#include <string>
#include <vector>

#include "core/caustic_estimator.h"
#include "core/scene/scene_reader.h"

namespace caustics::experiments {

/// One thing that was checked.
struct Finding {
    enum class Verdict { holds, fails, told };  ///< told: nothing that could fail
    std::string what;
    Verdict verdict = Verdict::told;
    std::string detail;
};

/// All that `verify SCENE` found.
struct SceneReport {
    std::vector<Finding> findings;
    bool holds() const;
    std::string text() const;  ///< one line a finding
};

/// Checks a scene with small pictures and the named methods (none: all but `none`):
///   * each light's account (light_audit.h);
///   * each method's picture, bit for bit the same with one thread, two, and as many as `options` has;
///   * each method against the reference in 6 x 4 cells of the picture. Their scatter over twelve seeds
///     estimates errors. `lighttrace` and `pathtrace` must agree within them; the methods may in addition be
///     off by a tenth of a cell's light and of the mean, and by 2 % in the whole, or by more (10 %) if that
///     shrinks with more effort: an estimate by the nearest photons gains light in the dark beside a
///     bright edge;
///   * whether light comes from a light by casters to a place that the camera sees, and where that ends.
/// Throws UnsupportedScene where a method that is named cannot serve the scene.
SceneReport verify_scene(SceneFile file, const std::vector<std::string>& methods,
                         const RunOptions& options);

}  // namespace caustics::experiments
