#include "experiments/cli/shape_lines.h"

#include <fmt/format.h>

#include "core/mesh/mesh_audit.h"

namespace caustics::experiments {
namespace {

std::string kind_of(const Shape& shape) {
    if (shape.primitive == Primitive::mesh)
        return fmt::format("mesh of {} triangles", triangle_count(shape));
    return ask_exact(shape, [](const auto& kind) { return fmt::format("exact {}", kind.type); });
}

// What a glass catalogue says of the inside.
std::string dispersion(const Bsdf& bsdf) {
    const auto* glass = std::get_if<Dielectric>(&bsdf.model);
    if (glass == nullptr || !glass->int_ior.is_dispersive()) return "";
    const double n_f = glass->int_ior.at(486.1327F);
    const double n_c = glass->int_ior.at(656.2725F);
    return fmt::format(", n_d {:.5f}, V_d {:.2f}", glass->int_ior.at(d_line),
                       (glass->int_ior.at(d_line) - 1) / (n_f - n_c));
}

// The casters after this one that share triangles with it.
std::string coincident(const Scene& scene, std::size_t index) {
    std::string text;
    const Shape& shape = scene.shapes()[index];
    for (std::size_t i = index + 1; i < scene.shapes().size(); ++i) {
        const Shape& other = scene.shapes()[i];
        if (other.primitive != Primitive::mesh || !is_caster(other.bsdf)) continue;
        const std::size_t common = common_triangles(shape.mesh, other.mesh);
        if (common > 0) text += fmt::format(", {} triangles lie on {}", common, other.name);
    }
    return text;
}

std::string flaws(const Scene& scene, std::size_t index, const std::vector<ExaminedMesh>& meshes) {
    std::string text;
    for (const ExaminedMesh& mesh : meshes)
        if (mesh.shape == index) text += listed(mesh.diagnosis);
    const Shape& shape = scene.shapes()[index];
    const bool is_mesh = shape.primitive == Primitive::mesh;
    return is_mesh && is_caster(shape.bsdf) ? text + coincident(scene, index) : text;
}

}  // namespace

std::vector<std::string> shape_lines(const Scene& scene, const std::vector<ExaminedMesh>& meshes) {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < scene.shapes().size(); ++i) {
        const Shape& shape = scene.shapes()[i];
        const bool caster = is_caster(shape.bsdf);
        const bool receiver = is_receiver(shape.bsdf);
        lines.push_back(fmt::format("  {:<16} {:<28} {}{}\n", shape.name, kind_of(shape),
                                    caster && receiver ? "caster and receiver"
                                    : caster           ? "caster"
                                                       : "receiver",
                                    (shape.radiance ? ", area light" : "") +
                                        dispersion(shape.bsdf) + flaws(scene, i, meshes)));
    }
    return lines;
}

}  // namespace caustics::experiments
