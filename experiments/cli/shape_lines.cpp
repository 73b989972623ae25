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

/// The faults of each shape: the flaws of meshes, and the casters after a caster that share triangles with it.
std::vector<std::string> flaws(const Scene& scene, const std::vector<ExaminedMesh>& meshes) {
    const std::vector<Shape>& shapes = scene.shapes();
    std::vector<std::string> texts(shapes.size());
    for (const ExaminedMesh& mesh : meshes) texts[mesh.shape] += listed(mesh.diagnosis);
    std::vector<std::size_t> casters;
    std::vector<const TriangleMesh*> caster_meshes;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        if (shapes[i].primitive != Primitive::mesh || !is_caster(shapes[i].bsdf)) continue;
        casters.push_back(i);
        caster_meshes.push_back(&shapes[i].mesh);
    }
    for (const auto& [first, second, count] : common_triangles(caster_meshes))
        texts[casters[first]] +=
            fmt::format(", {} triangles lie on {}", count, shapes[casters[second]].name);
    return texts;
}

}  // namespace

std::vector<std::string> shape_lines(const Scene& scene, const std::vector<ExaminedMesh>& meshes) {
    const std::vector<std::string> amiss = flaws(scene, meshes);
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < scene.shapes().size(); ++i) {
        const Shape& shape = scene.shapes()[i];
        const bool caster = is_caster(shape.bsdf);
        const bool receiver = is_receiver(shape.bsdf);
        lines.push_back(fmt::format(
            "  {:<16} {:<28} {}{}\n", shape.name, kind_of(shape),
            caster && receiver ? "caster and receiver"
            : caster           ? "caster"
                               : "receiver",
            (shape.radiance ? ", area light" : "") + dispersion(shape.bsdf) + amiss[i]));
    }
    return lines;
}

}  // namespace caustics::experiments
