#include "core/scene/shape_reader.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "core/base/lower_case.h"
#include "core/exact_shapes/shape_keys.h"
#include "core/geometry/tessellate.h"
#include "core/lights/area_light.h"
#include "core/material/bsdf_reader.h"
#include "core/math/coordinate_limit.h"
#include "core/mesh/exact_positions.h"
#include "core/mesh/mesh_io.h"
#include "core/shapes/cut_shape.h"
#include "core/shapes/heightfield_shape.h"
#include "core/shapes/lathe_shape.h"

namespace caustics::scene_file {
namespace {

bool is_similarity(const Transform& transform) {
    const Eigen::Matrix3d square = transform.linear().transpose() * transform.linear();
    const double scale = square.trace() / 3;
    return (square - scale * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= 1e-6 * scale;
}

// Keys that every shape has.
struct CommonKeys {
    std::optional<JsonNode> transform_node, resolution;
    Transform to_world = Transform::Identity();
    bool flip_normals = false;
    bool face_normals = false;

    CommonKeys(const JsonNode& node, const std::string& type) {
        transform_node = node.find("to_world");
        if (transform_node) to_world = read_transform(*transform_node);
        if (const auto flip = node.find("flip_normals")) flip_normals = flip->as_bool();
        const bool file = type == "obj" || type == "ply";
        const bool mesh = file || type == "cube" || type == "lathe" || type == "cut" ||
                          (type == "heightfield" && is_height_grid(node));
        if (file && node.has("resolution"))
            node.at("resolution")
                .fail("a mesh file has its own resolution; only analytic shapes take one");
        if (!file) resolution = node.find("resolution");
        const auto faces = node.find("face_normals");
        if (faces && !mesh && !resolution)
            faces->fail("only a mesh has face normals; give the shape a `resolution`");
        if (faces) face_normals = faces->as_bool();
    }

    int count(int least) const { return static_cast<int>(resolution->as_integer_in(least, 4096)); }
    Cells cells() const {
        if (!resolution->is_array()) return count(1);
        const std::vector<JsonNode> both = resolution->as_array();
        if (both.size() != 2) resolution->fail("must be a whole number or [nx, ny]");
        return {static_cast<int>(both[0].as_integer_in(1, 4096)),
                static_cast<int>(both[1].as_integer_in(1, 4096))};
    }

    void finish_mesh(TriangleMesh& mesh) const {
        if (face_normals) mesh.normals.clear();
        if (flip_normals) flip(mesh);
    }
};

void read_mesh_file(const JsonNode& node, const std::string& type, const CommonKeys& keys,
                    Shape& shape, Assets& assets) {
    shape.primitive = Primitive::mesh;
    MeshLoadOptions options;
    options.face_normals = keys.face_normals;
    options.flip_normals = keys.flip_normals;
    if (const auto orient = node.find("orient")) options.orient = orient->as_bool();
    shape.is_of_file = true;
    shape.is_oriented = options.orient;
    const JsonNode name = node.at("filename");
    const std::filesystem::path file = read_file_name(name, assets);
    if (lower_case(file.extension().string()) != "." + type)
        name.fail("a shape of type " + type + " takes a ." + type + " file (known: obj, ply)");
    shape.mesh = load_for(name, [&] { return load_mesh(file, options); });
    shape.to_world = keys.to_world;
}

// The cells of an exact shape's mesh; those along x and y may differ where its keys say so.
Cells cells_of(const CommonKeys& keys, int least, bool is_grid) {
    return is_grid ? keys.cells() : Cells(keys.count(least));
}

void read_exact(const JsonNode& node, Primitive primitive, CommonKeys keys, Shape& shape) {
    shape.primitive = primitive;
    ask_exact(shape, [&]<class Kind>(const Kind& kind) {
        if (Kind::needs_similarity && !keys.resolution && !is_similarity(keys.to_world))
            keys.transform_node->fail(std::string("an exact ") + Kind::type +
                                      " takes rotations, translations and one scale only; give it "
                                      "a `resolution` to stretch it");
        if constexpr (requires { Kind::read_placement(node); })
            keys.to_world = keys.to_world * Kind::read_placement(node);
        shape.to_world = keys.to_world;
        if (keys.resolution)
            shape.mesh = kind.tessellate(cells_of(keys, Kind::least_cells, Kind::is_grid));
        else
            shape.flip_normals = keys.flip_normals;
    });
    if (!keys.resolution) return;
    shape.primitive = Primitive::mesh;
    keys.finish_mesh(shape.mesh);
}

// Fails where a mesh is made so far from its own origin that its floats are too coarse.
void require_near_origin(const JsonNode& node, const TriangleMesh& mesh) {
    constexpr double most_sizes = 1000;
    const Eigen::AlignedBox3d box = exact_bounds(mesh);
    const double sizes = box.center().norm() / box.diagonal().norm();
    if (mesh.exact_positions.empty() && sizes > most_sizes)
        node.fail(
            fmt::format("lies {:.3g} times its size from its own origin, where floats are too "
                        "coarse (at most {:g} times; to_world moves it exactly)",
                        sizes, most_sizes));
}

// What is a mesh by its nature.
void set_mesh(const JsonNode& node, TriangleMesh mesh, const CommonKeys& keys, Shape& shape) {
    require_near_origin(node, mesh);
    shape.primitive = Primitive::mesh;
    shape.to_world = keys.to_world;
    shape.mesh = std::move(mesh);
    keys.finish_mesh(shape.mesh);
}

void read_heightfield(const JsonNode& node, const CommonKeys& keys, Shape& shape, Assets& assets) {
    const auto heights = read_heights(node, assets);
    if (const auto* field = std::get_if<SineHeightfield>(&heights)) {
        shape.field = *field;
        return read_exact(node, Primitive::heightfield, keys, shape);
    }
    if (keys.resolution) keys.resolution->fail("the heights have a resolution of their own");
    set_mesh(node, tessellate_grid(std::get<HeightGrid>(heights)), keys, shape);
}

template <class Kind>
ObjectText text_of() {
    if constexpr (requires { Kind::text(); })
        return Kind::text();
    else
        throw std::logic_error("a heightfield's keys are not those of its sines alone");
}

Primitive exact_of(const std::string& type) {
    const auto has_type = [&](Primitive primitive) {
        return ask_kind(primitive, {}, [&](const auto& kind) { return type == kind.type; });
    };
    return *std::ranges::find_if(exact_primitives, has_type);
}

Eigen::AlignedBox3d in_world(const Eigen::AlignedBox3d& local, const Transform& to_world) {
    Eigen::AlignedBox3d box;
    for (int i = 0; i < 8; ++i)
        box.extend(to_world * local.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
    return box;
}

// Fails unless floats hold the shape where it is, which may be flat, but no thread.
void require_size(const JsonNode& node, const Shape& shape) {
    const Eigen::AlignedBox3d local = local_bounds(shape);
    const Eigen::AlignedBox3d box = in_world(local, shape.to_world);
    require_near(node, {box.min(), box.max()});
    const Vec3d scales = shape.to_world.linear().colwise().norm().transpose();
    Vec3d extents = local.sizes().cwiseProduct(scales);
    std::ranges::sort(extents);
    const bool is_mesh = shape.primitive == Primitive::mesh;
    const char* const kind = is_mesh ? "a mesh" : "an exact shape";
    const double least = is_mesh ? smallest_mesh : smallest_size;
    if (!(extents[1] >= least))
        node.fail(fmt::format("is {:.3g} m wide, less than {:g} m, the least width of {}",
                              extents[1], least, kind));
    const double reach = std::max(box.max().maxCoeff(), -box.min().minCoeff());
    if (is_mesh && reach > farthest_vertex)
        node.fail(fmt::format("is a mesh that reaches {:.3g} m from the origin, beyond {:g} m",
                              reach, farthest_vertex));
}

// What is nested in a shape under keys of the user's choice: a bsdf and an emitter.
void read_nested(const JsonNode& node, Shape& shape, Assets& assets) {
    std::optional<std::string> bsdf_key;
    std::optional<std::string> emitter_key;
    const auto takes_one = [](const char* what, const std::string& first, const std::string& key) {
        return fmt::format("a shape takes one {}, and has \"{}\" and \"{}\"", what, first, key);
    };
    const auto children = node.children();
    node.finish();
    for (const auto& [key, child] : children) {
        const std::string type = lower_case(child.at("type").as_string());
        if (is_bsdf_type(type)) {
            if (bsdf_key) child.fail(takes_one("bsdf", *bsdf_key, key));
            bsdf_key = key;
            shape.bsdf = read_bsdf(child, assets);
            continue;
        }
        std::vector<std::string> known = bsdf_types();
        known.insert(known.begin(), "area");
        read_type(child, "bsdf or emitter", known, {"homogeneous", "heterogeneous"});
        if (emitter_key) child.fail(takes_one("emitter", *emitter_key, key));
        emitter_key = key;
        shape.radiance = AreaLight::read(child);
        child.finish();
        if (shape.primitive == Primitive::heightfield)
            child.fail("an exact heightfield cannot emit; give it a `resolution`");
    }
}

Keys file_keys() {
    return joined(
        mesh_keys(),
        {yes_or_no("orient",
                   "Turns triangles so that neighbours agree and closed parts face outwards, or "
                   "inwards if they lie inside an odd number of others. Open parts keep the side "
                   "of most of their area. Normals of the file turn with their triangles; "
                   "flip_normals is applied last.",
                   "false")});
}

}  // namespace

Objects shape_keys() {
    Objects all;
    for (const Primitive primitive : exact_primitives)
        all.push_back(
            ask_kind(primitive, {}, []<class Kind>(const Kind&) { return text_of<Kind>(); }));
    all.push_back({"cube", "A shape: the box from -1 to 1, a mesh.", parametric_keys("1")});
    all.push_back({"obj", "A shape: a mesh of a Wavefront file.",
                   joined(file_keys(), {file("The .obj file, relative to the scene's.")})});
    all.push_back({"ply", "A shape: a mesh of a PLY file.",
                   joined(file_keys(), {file("The .ply file, relative to the scene's.")})});
    for (Objects family : {heightfield_keys(), lathe_keys(), cut_keys()})
        for (ObjectText& object : family) all.push_back(std::move(object));
    return all;
}

const std::vector<std::string>& shape_types() {
    static const std::vector<std::string> types = [] {
        std::vector<std::string> all;
        for (const Primitive primitive : exact_primitives)
            all.push_back(
                ask_kind(primitive, {}, [](const auto& kind) -> std::string { return kind.type; }));
        for (const char* mesh : {"cube", "obj", "ply", "heightfield", "lathe", "cut"})
            all.emplace_back(mesh);
        return all;
    }();
    return types;
}

const std::vector<std::string>& later_shape_types() {
    static const std::vector<std::string> types{"instance", "shapegroup", "bsplinecurve", "sdfgrid",
                                                "serialized"};
    return types;
}

Eigen::AlignedBox3d world_bounds(const Shape& shape) {
    return in_world(local_bounds(shape), shape.to_world);
}

Shape read_shape(const std::string& name, const JsonNode& node, Assets& assets) {
    const std::string type = read_type(node, "shape", shape_types(), later_shape_types());
    Shape shape;
    shape.name = name;
    const CommonKeys keys(node, type);
    if (type == "obj" || type == "ply")
        read_mesh_file(node, type, keys, shape, assets);
    else if (type == "cube")
        set_mesh(node, tessellate_cube(keys.resolution ? keys.count(1) : 1), keys, shape);
    else if (type == "lathe")
        set_mesh(node, read_lathe(node, keys.resolution ? keys.count(3) : 64), keys, shape);
    else if (type == "cut")
        set_mesh(node, read_cut(node, keys.resolution), keys, shape);
    else if (type == "heightfield")
        read_heightfield(node, keys, shape, assets);
    else
        read_exact(node, exact_of(type), keys, shape);
    require_size(node, shape);
    read_nested(node, shape, assets);
    return shape;
}

}  // namespace caustics::scene_file
