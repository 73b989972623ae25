#pragma once

#include "core/material/ior.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics::scene_file {

/// An index of refraction: a number, one of Mitsuba's names or a law of the wavelength (`cauchy`,
/// `sellmeier`, `abbe`).
Ior read_ior(const JsonNode& parent, const std::string& key, const Ior& fallback);

/// Laws of dispersion, with their keys.
Objects ior_keys();

}  // namespace caustics::scene_file
