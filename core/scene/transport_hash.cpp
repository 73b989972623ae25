#include "core/scene/transport_hash.h"

#include "core/math/value_hash.h"
#include "core/scene/eye_medium.h"

namespace caustics {

namespace {

void add_bsdf(const Bsdf& bsdf, ValueHash& hash) {
    hash.add(is_caster(bsdf));
    hash.add(bsdf.twosided);
    if (is_receiver(bsdf)) {
        hash.add(scatters_from(bsdf, true));
        hash.add(scatters_from(bsdf, false));
    }
    // A photon map does not depend on how receivers scatter.
    std::visit(
        [&](const auto& model) {
            if constexpr (requires { model.add_to(hash); }) model.add_to(hash);
        },
        bsdf.model);
    if (bsdf.mirror) {
        hash.add(bsdf.mirror->weight);
        hash.add(bsdf.mirror->reflectance);
    }
}

void add_shape(const Shape& shape, ValueHash& hash) {
    hash.add(shape.primitive);
    hash.add(shape.flip_normals);
    hash.add(shape.to_world.matrix());
    hash.add(shape.field.half_size);
    hash.add(shape.field.waves.size());
    for (const SineWave& wave : shape.field.waves) {
        hash.add(wave.amplitude);
        hash.add(wave.wave_vector);
        hash.add(wave.phase);
    }
    hash.add(shape.mesh.positions);
    hash.add(shape.mesh.normals);
    hash.add(shape.mesh.triangles);
    add_bsdf(shape.bsdf, hash);
    hash.add(shape.radiance.has_value());
    if (shape.radiance) hash.add(*shape.radiance);
}

}  // namespace

std::uint64_t transport_hash(const Scene& scene) {
    ValueHash hash;
    hash.add(scene.shapes().size());
    for (const Shape& shape : scene.shapes()) add_shape(shape, hash);
    hash.add(scene.lights().size());
    for (const Light& light : scene.lights()) {
        hash.add(static_cast<std::size_t>(family_of(light)));
        add_to(hash, light);
    }
    // Maps of before forget the medium behind a mirror and before a lamp.
    if (absorbs_at_mirrors_or_lamps(scene)) hash.add(std::size_t{1});
    return hash.value();
}

std::uint64_t whole_transport_hash(const Scene& scene) {
    ValueHash hash;
    hash.add(transport_hash(scene));
    for (const Shape& shape : scene.shapes()) {
        std::visit(
            [&](const auto& model) {
                if constexpr (requires { model.add_scattering_to(hash); })
                    model.add_scattering_to(hash);
            },
            shape.bsdf.model);
        // Where textures lie.
        if (is_receiver(shape.bsdf) && !shape.mesh.uvs.empty()) hash.add(shape.mesh.uvs);
    }
    return hash.value();
}

}  // namespace caustics
