#include "core/material/conductor.h"

namespace caustics {

using namespace scene_file;

ObjectText Conductor::text() {
    const KeyText reflected = colour(
        "specular_reflectance", "Share of the reflected light that is kept.", "", "1", "0 to 1");
    return {"conductor",
            "A bsdf, in a shape: a mirror; the shape is a caster.",
            {type_key(), choice("material", "The perfect mirror.", "none", "none"), reflected}};
}

Conductor Conductor::read(const JsonNode& node, Assets&) {
    if (const auto material = node.find("material"))
        if (material->as_string() != "none")
            material->fail("material \"" + material->as_string() +
                           "\" is not supported (yet) (known: none)");
    return {read_colour(node, "specular_reflectance", 1, 1)};
}

void Conductor::add_to(ValueHash& hash) const { hash.add(specular_reflectance); }

}  // namespace caustics
