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

std::string flaws(const Scene& scene, std::size_t index) {
    const Shape& shape = scene.shapes()[index];
    if (shape.primitive != Primitive::mesh || !is_caster(shape.bsdf)) return "";
    const std::size_t open = open_edge_count(shape.mesh);
    std::string text;
    if (open > 0) text += fmt::format(", {} open edges", open);
    const bool glass = std::holds_alternative<Dielectric>(shape.bsdf.model);
    if (open == 0 && glass && enclosed_volume(shape.mesh) < 0)
        text += ", faces inwards (right for a cavity only)";
    return text + coincident(scene, index);
}

}  // namespace

std::vector<std::string> shape_lines(const Scene& scene) {
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
            (shape.radiance ? ", area light" : "") + dispersion(shape.bsdf) + flaws(scene, i)));
    }
    return lines;
}

}  // namespace caustics::experiments
