#include "core/material/dielectric.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/material/fresnel.h"

#include "core/material/ior_reader.h"

namespace caustics {

using namespace scene_file;

float Dielectric::relative_ior(bool front, float nm) const {
    if (is_dispersive()) {
        const double ratio = int_ior.at(nm) / ext_ior.at(nm);
        return static_cast<float>(front ? ratio : 1 / ratio);
    }
    const auto inside = static_cast<float>(int_ior.n());
    const auto outside = static_cast<float>(ext_ior.n());
    return front ? inside / outside : outside / inside;
}

SpecularSplit Dielectric::split(const SpecularArrival& light) const {
    const auto& [front, ng, n, w, nm] = light;
    SpecularSplit split;
    split.eta = relative_ior(front, nm);
    const float cos_i = std::min(n.dot(w), 1.0F);
    split.reflected = reflect(w, n);
    const float inverse_eta = 1 / split.eta;
    const float sin2_t = (1 - cos_i * cos_i) * inverse_eta * inverse_eta;
    const bool refracts = sin2_t < 1;
    const float cos_t = refracts ? std::sqrt(1 - sin2_t) : 0;
    const float reflectance = refracts ? fresnel_reflectance(cos_i, cos_t, split.eta) : 1;
    const Spectrum reflected = specular_reflectance * reflectance;
    ((ng.dot(split.reflected) > 0) == front ? split.reflected_weight : split.lost_weight) =
        reflected;
    if (refracts) {
        const Vec3 t = (cos_i * inverse_eta - cos_t) * n - inverse_eta * w;
        split.refracted = t * (1 / t.norm());
        const Spectrum refracted = specular_transmittance * (1 - reflectance);
        if ((ng.dot(t) > 0) != front)
            split.refracted_weight = refracted;
        else
            split.lost_weight += refracted;
    }
    return split;
}

ObjectText Dielectric::text() {
    const KeyText reflected = colour(
        "specular_reflectance", "Share of the reflected light that is kept.", "", "1", "0 to 1");
    const auto ior = [](const std::string& key, const std::string& meaning,
                        const std::string& usual) {
        return KeyText{.key = key,
                       .meaning = meaning,
                       .type = "number, Mitsuba's name or law",
                       .usual = usual,
                       .choices = "0.1 to 10"};
    };
    return {"dielectric",
            "A bsdf, in a shape: smooth glass or water; the shape is a caster. Light counts as "
            "unpolarised at each interface: near Brewster's angle two of them pass 10 % too little "
            "(n = 2.4; 0.6 % for n = 1.5), and reflect half of what is right.",
            {type_key(), ior("int_ior", "Refractive index behind the surface.", "bk7"),
             ior("ext_ior", "Refractive index in front of it.", "air"),
             colour("absorption", "Of the inside.", "1/m", "0", "0 to 1e+30"),
             colour("ext_absorption", "Of the outside.", "1/m", "0", "0 to 1e+30"), reflected,
             colour("specular_transmittance", "Share of the refracted light that is kept.", "", "1",
                    "0 to 1")}};
}

Dielectric Dielectric::read(const JsonNode& node, Assets&) {
    Dielectric glass;
    glass.int_ior = read_ior(node, "int_ior", glass.int_ior);
    glass.ext_ior = read_ior(node, "ext_ior", glass.ext_ior);
    glass.absorption = read_colour(node, "absorption", 0, unlimited);
    glass.ext_absorption = read_colour(node, "ext_absorption", 0, unlimited);
    glass.specular_reflectance = read_colour(node, "specular_reflectance", 1, 1);
    glass.specular_transmittance = read_colour(node, "specular_transmittance", 1, 1);
    return glass;
}

void Dielectric::add_to(ValueHash& hash) const {
    for (const Ior* ior : {&int_ior, &ext_ior})
        if (ior->is_dispersive())
            hash.add(ior->numbers());
        else
            hash.add(static_cast<float>(ior->n()));
    for (const Spectrum& s :
         {absorption, ext_absorption, specular_reflectance, specular_transmittance})
        hash.add(s);
}

MitsubaBsdf Dielectric::to_mitsuba() const {
    MitsubaBsdf bsdf{"dielectric",
                     {{"int_ior", int_ior.n()},
                      {"ext_ior", ext_ior.n()},
                      {"specular_reflectance", specular_reflectance},
                      {"specular_transmittance", specular_transmittance}}};
    if (!is_black(absorption) || !is_black(ext_absorption))
        bsdf.refused = {
            "Mitsuba's dielectric does not absorb; set absorption and ext_absorption of the "
            "dielectric to 0",
            "/bsdf/absorption=0"};
    else if (is_dispersive())
        bsdf.refused = {
            "Mitsuba's dielectric has no dispersion; write a scene for each of some "
            "wavelengths (--wavelengths 16), or give it one index",
            fmt::format("/bsdf/int_ior={:.6g}", int_ior.n())};
    return bsdf;
}

PovraySurface Dielectric::to_povray() const {
    const auto ratio = [&](float nm) { return int_ior.at(nm) / ext_ior.at(nm); };
    PovrayInterior interior{ext_ior, ratio(0), {}, absorption};
    if (is_dispersive()) interior.dispersion = ratio(400) / ratio(700);
    PovraySurface surface{.interior = interior};
    if (!(specular_reflectance == 1).all() || !(specular_transmittance == 1).all())
        surface.refused.reason =
            "specular_reflectance and specular_transmittance of a dielectric are not "
            "exported to POV-Ray; leave them 1";
    else if (!is_black(ext_absorption))
        surface.refused.reason =
            "POV-Ray knows no absorption outside of a dielectric (ext_absorption)";
    return surface;
}

}  // namespace caustics
