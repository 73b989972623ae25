#include "experiments/run/mesh_notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <variant>

namespace caustics::experiments {

namespace {

const Dielectric* glass_of(const Shape& shape) {
    return std::get_if<Dielectric>(&shape.bsdf.model);
}

/// True if its front and its back treat light in different ways.
bool has_two_sides(const Shape& shape) {
    return glass_of(shape) != nullptr || !shape.bsdf.twosided || shape.radiance;
}

/// "1 part", "2 parts".
std::string counted(std::size_t count, const char* noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string how_to_orient(const Shape& shape) {
    if (!shape.is_of_file) return "";
    return shape.is_oriented ? "" : "; \"orient\": true turns them";
}

/// True if its fronts may well look inwards: of glass, in another dielectric or with the denser medium outside; of
/// other surfaces, as the walls of a room that holds the camera.
bool may_face_inwards(const Scene& scene, const Shape& shape) {
    const Box own = bounds(shape);
    const Dielectric* const glass = glass_of(shape);
    if (glass == nullptr) return own.contains(scene.camera().position());
    if (glass->int_ior.at(d_line) < glass->ext_ior.at(d_line)) return true;
    return std::ranges::any_of(scene.shapes(), [&](const Shape& other) {
        return &other != &shape && glass_of(other) != nullptr && bounds(other).contains(own);
    });
}

void note_facing(const Scene& scene, const Shape& shape, const MeshDiagnosis& found,
                 std::vector<std::string>& all) {
    const bool is_glass = glass_of(shape) != nullptr;
    const char* const effect =
        is_glass ? "light that meets them goes on as if it left the medium, not entered it"
                 : "they are black from the side that should be seen";
    if (found.turned_triangles > 0)
        all.push_back(fmt::format(
            "mesh {}: {} of {} triangles face the wrong way, against their neighbours in {}: {}{}",
            shape.name, found.turned_triangles, shape.mesh.triangles.size(),
            counted(found.mixed_parts, "part"), effect, how_to_orient(shape)));
    if (found.inside_out_parts > 0 && !may_face_inwards(scene, shape))
        all.push_back(fmt::format(
            "mesh {}: {} of {} inside out ({} triangles face inwards): {}{}", shape.name,
            found.inside_out_parts, counted(found.parts, "part"), found.inside_out_triangles,
            effect,
            shape.is_of_file ? how_to_orient(shape) : "; flip_normals turns the whole mesh"));
    if (is_glass && found.outward_cavities > 0)
        all.push_back(fmt::format(
            "mesh {}: {} inside another one and facing outwards: a cavity faces inwards, and glass "
            "in glass is a shape of its own{}",
            shape.name,
            counted(found.outward_cavities, "part") +
                (found.outward_cavities == 1 ? " lies" : " lie"),
            how_to_orient(shape)));
    if (found.one_sided_parts > 0)
        all.push_back(fmt::format(
            "mesh {}: {} of {} with one side only, as a Moebius strip: where the front lies cannot "
            "be told",
            shape.name, found.one_sided_parts, counted(found.parts, "part")));
    if (shape.is_oriented && found.parts_of_no_outside() > 0)
        all.push_back(fmt::format(
            "mesh {}: the outside of {} of {} cannot be told, since they are open or enclose no "
            "volume: orient kept the side of most of their area",
            shape.name, found.parts_of_no_outside(), counted(found.parts, "part")));
}

void note_gaps(const Shape& shape, const MeshDiagnosis& found, std::vector<std::string>& all) {
    if (glass_of(shape) == nullptr) return;
    // Shapes of the scene file are open where they were asked to be.
    if (shape.is_of_file && found.hollow_parts > 0)
        all.push_back(fmt::format(
            "mesh {}: {} of {} closed but for holes ({} with {} in all): light that passes a "
            "hole does not enter the medium, and goes on in the wrong one, unless another shape "
            "closes it",
            shape.name, found.hollow_parts, counted(found.parts, "part"),
            counted(found.holes, "hole"), counted(found.open_edges, "open edge")));
    if (found.duplicates > 0)
        all.push_back(fmt::format(
            "mesh {}: {} of {} triangles with the corners of another one: which of the two "
            "light meets is left to rounding",
            shape.name, found.duplicates, shape.mesh.triangles.size()));
}

/// Bounds of all but one shape, with the camera and the lights that have a place.
Box bounds_of_the_rest(const Scene& scene, std::uint32_t left_out) {
    Box box(scene.camera().position());
    for (std::uint32_t i = 0; i < scene.shapes().size(); ++i)
        if (i != left_out) box.extend(bounds(scene.shapes()[i]));
    for (const Light& light : scene.lights())
        if (const auto point = point_of(light); point && point->position)
            box.extend(*point->position);
    return box;
}

/// True if the camera sees all of a box within a pixel.
bool is_within_a_pixel(const Camera& camera, const Box& box) {
    const auto distance = static_cast<double>((box.center() - camera.position()).norm());
    const auto size = static_cast<double>(box.diagonal().norm());
    return size < distance * std::sqrt(camera.pixel_area());
}

/// A caster that a file brings in another unit than the scene's, as its size suggests.
std::optional<std::string> odd_scale(const Scene& scene, std::uint32_t index) {
    constexpr double absurd = 100;
    constexpr double odd = 10;  // for what is large enough to hold the camera
    constexpr double tiny = 1e-3;
    const Shape& shape = scene.shapes()[index];
    if (!shape.is_of_file || !is_caster(shape.bsdf)) return {};
    const Box own = bounds(shape);
    const Box rest = bounds_of_the_rest(scene, index);
    const auto size = static_cast<double>(own.diagonal().norm());
    const auto times = size / static_cast<double>(rest.diagonal().norm());
    const bool is_huge =
        times >= absurd || (times >= odd && own.contains(scene.camera().position()));
    if (!is_huge && !(times <= tiny && is_within_a_pixel(scene.camera(), own))) return {};
    return fmt::format(
        "mesh {}: is {:.3g} m wide, {:.2g} times the rest of the scene: if its file has {}, put "
        "{{\"scale\": {}}} first into to_world",
        shape.name, size, times,
        is_huge ? "millimetres and the scene metres" : "metres and the scene millimetres",
        is_huge ? "0.001" : "1000");
}

}  // namespace

std::vector<ExaminedMesh> examine_meshes(const Scene& scene) {
    std::vector<ExaminedMesh> all;
    for (std::uint32_t i = 0; i < scene.shapes().size(); ++i) {
        const Shape& shape = scene.shapes()[i];
        if (shape.primitive == Primitive::mesh && (is_caster(shape.bsdf) || has_two_sides(shape)))
            all.push_back({i, diagnose(shape.mesh)});
    }
    return all;
}

std::vector<std::string> mesh_notes(const Scene& scene, const std::vector<ExaminedMesh>& meshes) {
    std::vector<std::string> all;
    for (const ExaminedMesh& mesh : meshes) {
        const Shape& shape = scene.shapes()[mesh.shape];
        if (has_two_sides(shape)) note_facing(scene, shape, mesh.diagnosis, all);
        note_gaps(shape, mesh.diagnosis, all);
        if (const auto scale = odd_scale(scene, mesh.shape)) all.push_back(*scale);
    }
    return all;
}

std::vector<std::string> mesh_notes(const Scene& scene) {
    return mesh_notes(scene, examine_meshes(scene));
}

std::string listed(const MeshDiagnosis& found) {
    std::string text;
    const auto add = [&](std::size_t count, const std::string& words) {
        if (count > 0) text += ", " + words;
    };
    add(found.parts > 1 ? found.parts : 0, counted(found.parts, "part"));
    add(found.open_edges,
        counted(found.open_edges, "open edge") + " along " + counted(found.holes, "border"));
    add(found.turned_triangles,
        counted(found.turned_triangles, "triangle") + " turned against their neighbours");
    add(found.inside_out_parts,
        (found.parts == 1 ? std::string("faces inwards")
                          : fmt::format("{} of them face{} inwards", found.inside_out_parts,
                                        found.inside_out_parts == 1 ? "s" : "")) +
            " (right for a cavity only)");
    add(found.cavities, counted(found.cavities, "part") + " inside others");
    add(found.outward_cavities, fmt::format("{} of these facing outwards", found.outward_cavities));
    add(found.one_sided_parts, counted(found.one_sided_parts, "part") + " with one side only");
    add(found.duplicates, counted(found.duplicates, "triangle") + " twice");
    add(found.crowded_edges,
        counted(found.crowded_edges, "edge") + " shared by more than 2 triangles");
    add(found.without_area, counted(found.without_area, "triangle") + " without area");
    return text;
}

}  // namespace caustics::experiments
