#include "core/material/conductor.h"

#include "core/base/lower_case.h"
#include "core/material/fresnel.h"

namespace caustics {

using namespace scene_file;

SpecularSplit Conductor::split(const SpecularArrival& light) const {
    SpecularSplit split;
    split.reflected = reflect(light.w, light.n);
    ((light.ng.dot(split.reflected) > 0) == light.front ? split.reflected_weight
                                                        : split.lost_weight) = specular_reflectance;
    return split;
}

ObjectText Conductor::text() {
    const KeyText reflected = colour(
        "specular_reflectance", "Share of the reflected light that is kept.", "", "1", "0 to 1");
    return {"conductor",
            "A bsdf, in a shape: a mirror; the shape is a caster.",
            {type_key(), choice("material", "The perfect mirror.", "none", "none"), reflected}};
}

Conductor Conductor::read(const JsonNode& node, Assets&) {
    if (const auto material = node.find("material"))
        if (lower_case(material->as_string()) != "none")
            material->fail("material \"" + material->as_string() +
                           "\" is not supported (yet) (known: none)");
    return {read_colour(node, "specular_reflectance", 1, 1)};
}

void Conductor::add_to(ValueHash& hash) const { hash.add(specular_reflectance); }

MitsubaBsdf Conductor::to_mitsuba() const {
    return {"conductor",
            {{"material", std::string("none")}, {"specular_reflectance", specular_reflectance}}};
}

PovraySurface Conductor::to_povray() const {
    return {.diffuse = 0, .reflection = specular_reflectance};
}

}  // namespace caustics
