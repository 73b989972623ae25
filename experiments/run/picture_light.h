#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/render/renderer.h"
#include "core/scene/scene.h"
#include "experiments/run/method.h"

namespace caustics::experiments {

/// The caustic of a picture on one receiver, where pixels see nothing but that receiver, beside what light paths bring to
/// those pixels. Sums are means over the whole film [W m⁻² sr⁻¹, mean of channels].
struct ReceiverLight {
    std::string receiver;
    double picture = 0;
    double paths = 0;
    double error =
        0;  ///< standard error of `picture / paths`, from above where pixels differ by more than noise

    double ratio() const { return picture / paths; }
};

/// The light of a picture's caustic by receiver, and of all receivers together.
struct PictureLight {
    std::vector<ReceiverLight> receivers;  ///< that light paths reached, in the scene's order
    ReceiverLight all;
    bool is_open = false;  ///< more paths would tell whether the sums differ
};

/// The picture's sums beside those of 50,000 light paths of up to 1,000 events, or of 400,000 where these leave a
/// difference open. None for `lighttrace`, whose picture such paths are, and where no path came to a pixel that sees one receiver alone. `photons` is how many photons
/// the picture is made of, or 0. Where the rendering has no errors of pixels, differences between neighbours stand for
/// them. With `few_paths` these are left out. The same for any number
/// of threads.
std::optional<PictureLight> picture_light(const Scene& scene, const Rendering& rendering,
                                          const Method& method, double photons, int threads,
                                          bool few_paths = false);

/// By receiver: "picture", "paths", "ratio" and "error"; those of all under "ratio" and "error".
nlohmann::json to_json(const PictureLight& light);

/// A line where the picture has 1 % more or less light than arrives, and the difference is none of chance.
std::optional<std::string> note_on(const PictureLight& light);

}  // namespace caustics::experiments
