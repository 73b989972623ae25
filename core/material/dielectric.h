#pragma once

#include "core/material/bsdf_words.h"
#include "core/material/ior.h"
#include "core/material/specular_split.h"
#include "core/math/spectrum.h"
#include "core/math/value_hash.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics {

/// A smooth interface between two lossless or absorbing media. The inside is the side away from
/// the geometric normal.
struct Dielectric {
    Ior int_ior = 1.5046F;
    Ior ext_ior = 1.000277F;
    Spectrum absorption = Spectrum::Zero();      ///< Beer's law inside [1/m]
    Spectrum ext_absorption = Spectrum::Zero();  ///< Beer's law outside [1/m]
    Spectrum specular_reflectance = Spectrum::Ones();
    Spectrum specular_transmittance = Spectrum::Ones();

    bool is_dispersive() const { return int_ior.is_dispersive() || ext_ior.is_dispersive(); }
    /// Index of refraction behind the interface over that before it, for light that arrives on its front or
    /// back, at a wavelength [nm]; 0: as Ior::at.
    float relative_ior(bool front, float nm) const;

    SpecularSplit split(const SpecularArrival& light) const;
    /// Absorption [1/m] outside or inside.
    const Spectrum& medium(bool outside) const { return outside ? ext_absorption : absorption; }

    /// What is asked of every model of a surface; see bsdf.h.
    static ObjectText text();
    static Dielectric read(const JsonNode& node, scene_file::Assets& assets);
    void add_to(ValueHash& hash) const;
    MitsubaBsdf to_mitsuba() const;
    PovraySurface to_povray() const;
};

}  // namespace caustics
