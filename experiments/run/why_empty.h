#pragma once

#include <optional>
#include <string>

#include "experiments/run/method.h"

namespace caustics {
class Film;
}

namespace caustics::experiments {

/// Why the layer `caustic` of a method's picture is black all over, in one line; empty where it is not,
/// and for the method `none`. Told by what building and rendering counted and, where that is not
/// enough, by light paths traced to find out.
std::optional<std::string> why_empty(const Scene& scene, const Method& method, const Film& film,
                                     const BuildReport& report, const Counters& counters);

}  // namespace caustics::experiments
