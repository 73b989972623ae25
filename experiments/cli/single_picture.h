#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run/cli_options.h"
#include "experiments/run/render_and_score.h"

namespace caustics::experiments {

/// Options of the verb `render`.
struct RenderOptions {
    SceneOptions scene;
    MethodOptions method;
    IndirectOptions indirect;
    RunFlags run;
    int spp = 0;
    std::optional<double> exposure;
    std::optional<double> seconds;  ///< CPU seconds that the whole command is to take
    bool has_few_light_paths = false;
    std::string work;  ///< the scene's number that takes them; empty: the method's
    std::vector<std::string> outputs;
};

/// A picture with all that is told of it.
struct SinglePicture {
    RunRequest request;
    RunResult result;
    Seconds took;           ///< building and rendering
    double render_cpu = 0;  ///< of it, rendering [CPU s]
    double plan_cpu = 0;    ///< of it, deciding how the work is done, however much it is [CPU s]
    double told_cpu = 0;    ///< what was then found out to be told of the picture [CPU s]
};

/// A scene that is loaded, of which any number of pictures can be made.
class LoadedScene {
public:
    /// Throws InputError where the picture that the options ask for could not be made or written.
    explicit LoadedScene(const RenderOptions& options);

    const Scene& scene() const { return scene_; }
    /// Without its shapes.
    const SceneFile& file() const { return file_; }

    /// The picture that the options ask for, or one of so many of its pixels. `check` is called as work goes on and may throw.
    SinglePicture picture_of(const RenderOptions& options, int pixel_step = 1,
                             Telling telling = Telling::all,
                             const std::function<void()>& check = {}) const;

private:
    SceneFile file_;
    Scene scene_;
};

}  // namespace caustics::experiments
