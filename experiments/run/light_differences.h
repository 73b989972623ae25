#pragma once

#include <string>
#include <vector>

#include "core/render/film.h"

namespace caustics::experiments {

/// Where the configurations that two pictures carry with them ask for different light, "max_bounces:
/// 3 against 16" or "/floor/bsdf/alpha: 0.1 against 0.5": values of the scene but its sampler, files
/// that it names, and parameters that say which light paths count; where `layer` is "indirect", or
/// empty for the whole picture, also those of the indirect method. Nothing is said of a picture
/// without a configuration, another program's.
std::vector<std::string> light_differences(const Film& picture, const Film& reference,
                                           const std::string& layer);

}  // namespace caustics::experiments
