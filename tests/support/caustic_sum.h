#pragma once

#include "core/render/film.h"

namespace caustics::support {

/// Sum of a picture's caustic (green) over that of light tracing, over the pixels that light paths reach.
double share_of_traced(const Film& picture, const Film& traced);

}  // namespace caustics::support
