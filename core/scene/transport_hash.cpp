#include "core/scene/transport_hash.h"

#include <string_view>
#include <type_traits>

#include "core/base/hash.h"

namespace caustics {

namespace {

class Digest {
public:
    /// A value without padding.
    template <typename T>
    void add(const T& value) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        add_bytes(&value, sizeof(value));
    }
    template <typename Scalar, int rows, int columns>
    void add(const Eigen::Matrix<Scalar, rows, columns>& m) {
        add_bytes(m.data(), sizeof(Scalar) * static_cast<std::size_t>(m.size()));
    }
    void add(const Spectrum& s) { add_bytes(s.data(), 3 * sizeof(float)); }
    /// A list of plain values without padding.
    template <typename T>
    void add(const std::vector<T>& list) {
        add(list.size());
        add_bytes(list.data(), list.size() * sizeof(T));
    }
    std::uint64_t value() const { return state_; }

private:
    void add_bytes(const void* data, std::size_t size) {
        state_ = fnv1a({static_cast<const char*>(data), size}, state_);
    }
    std::uint64_t state_ = fnv1a("");
};

static_assert(sizeof(Vec3) == 3 * sizeof(float));

void add_bsdf(const Bsdf& bsdf, Digest& digest) {
    digest.add(is_caster(bsdf));
    digest.add(bsdf.twosided);
    if (is_receiver(bsdf)) {
        digest.add(scatters_from(bsdf, true));
        digest.add(scatters_from(bsdf, false));
    }
    if (const auto* glass = std::get_if<Dielectric>(&bsdf.model)) {
        for (const Ior* ior : {&glass->int_ior, &glass->ext_ior})
            if (ior->is_dispersive())
                digest.add(ior->numbers());
            else
                digest.add(static_cast<float>(ior->n()));
        for (const Spectrum& s : {glass->absorption, glass->ext_absorption,
                                  glass->specular_reflectance, glass->specular_transmittance})
            digest.add(s);
    }
    if (const auto* mirror = std::get_if<Conductor>(&bsdf.model))
        digest.add(mirror->specular_reflectance);
    if (bsdf.mirror) {
        digest.add(bsdf.mirror->weight);
        digest.add(bsdf.mirror->reflectance);
    }
}

void add_shape(const Shape& shape, Digest& digest) {
    digest.add(shape.primitive);
    digest.add(shape.flip_normals);
    digest.add(shape.to_world.matrix());
    digest.add(shape.field.half_size);
    digest.add(shape.field.waves.size());
    for (const SineWave& wave : shape.field.waves) {
        digest.add(wave.amplitude);
        digest.add(wave.wave_vector);
        digest.add(wave.phase);
    }
    digest.add(shape.mesh.positions);
    digest.add(shape.mesh.normals);
    digest.add(shape.mesh.triangles);
    add_bsdf(shape.bsdf, digest);
    digest.add(shape.radiance.has_value());
    if (shape.radiance) digest.add(*shape.radiance);
}

struct AddLight {
    Digest& digest;
    void operator()(const PointLight& light) const {
        digest.add(light.position);
        digest.add(light.intensity);
        if (!light.spot) return;
        digest.add(light.spot->axis);
        digest.add(light.spot->beam_width);
        digest.add(light.spot->cutoff);
    }
    void operator()(const DirectionalLight& light) const {
        digest.add(light.direction);
        digest.add(light.irradiance);
    }
    void operator()(const ConstantLight& light) const { digest.add(light.radiance); }
    void operator()(const AreaLight& light) const {
        digest.add(light.shape);
        digest.add(light.radiance);
    }
};

// As maps that are kept know the kinds.
std::size_t kind_number(const Light& light) {
    if (std::holds_alternative<PointLight>(light)) return 0;
    if (std::holds_alternative<DirectionalLight>(light)) return 1;
    return std::holds_alternative<AreaLight>(light) ? 2 : 3;
}

}  // namespace

std::uint64_t transport_hash(const Scene& scene) {
    Digest digest;
    digest.add(scene.shapes().size());
    for (const Shape& shape : scene.shapes()) add_shape(shape, digest);
    digest.add(scene.lights().size());
    for (const Light& light : scene.lights()) {
        digest.add(kind_number(light));
        std::visit(AddLight{digest}, light);
    }
    return digest.value();
}

}  // namespace caustics
