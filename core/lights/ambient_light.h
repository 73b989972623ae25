#pragma once

#include "core/math/spectrum.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics {

/// `ambient`: radiance that receivers are lit by from all sides without shadows, times their albedo. It sends
/// no rays and makes no caustics, so it is no Light, but a number of the scene [W m^-2 sr^-1].
struct AmbientLight {
    static ObjectText text();
    static Spectrum read(const JsonNode& node);
};

}  // namespace caustics
