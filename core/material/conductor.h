#pragma once

#include "core/material/bsdf_words.h"
#include "core/material/specular_split.h"
#include "core/math/spectrum.h"
#include "core/math/value_hash.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics {

/// A perfect mirror (Mitsuba's `conductor` of material `none`).
struct Conductor {
    Spectrum specular_reflectance = Spectrum::Ones();

    SpecularSplit split(const SpecularArrival& light) const;

    /// What is asked of every model of a surface; see bsdf.h.
    static ObjectText text();
    static Conductor read(const JsonNode& node, scene_file::Assets& assets);
    void add_to(ValueHash& hash) const;
    MitsubaBsdf to_mitsuba() const;
    PovraySurface to_povray() const;
};

}  // namespace caustics
