#include "core/material/dielectric.h"

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
            "A bsdf, in a shape: smooth glass or water; the shape is a caster.",
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

}  // namespace caustics
