#include "core/shapes/shape_reader.h"

#include <algorithm>
#include <cmath>

#include "core/base/lower_case.h"
#include "core/geometry/mesh_io.h"
#include "core/geometry/tessellate.h"
#include "core/lights/area_light.h"
#include "core/material/bsdf_reader.h"
#include "core/shapes/cut_shape.h"
#include "core/shapes/heightfield_shape.h"
#include "core/shapes/lathe_shape.h"

namespace caustics::scene_file {
namespace {

double read_radius(const JsonNode& node) {
    const auto radius = node.find("radius");
    if (!radius) return 1;
    const double value = radius->as_number_in(0, unlimited);
    if (value == 0) radius->fail("must be above 0");
    return value;
}

// The unit sphere -> centre and radius.
Transform read_sphere_placement(const JsonNode& node) {
    const auto centre = node.find("center");
    const double radius = read_radius(node);
    return Eigen::Translation3d(centre ? read_vector(*centre) : Vec3d::Zero().eval()) *
           Eigen::Scaling(radius);
}

// Rotation from z to a unit axis, by Duff et al. 2017, as in Mitsuba: where u = 0 lies follows.
Eigen::Matrix3d frame_along(const Vec3d& n) {
    const double sign = std::copysign(1.0, n.z());
    const double a = -1 / (sign + n.z());
    const double b = n.x() * n.y() * a;
    Eigen::Matrix3d frame;
    frame.col(0) << 1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x();
    frame.col(1) << b, sign + n.y() * n.y() * a, -n.y();
    frame.col(2) = n;
    return frame;
}

// The unit cylinder along z in [0, 1] -> p0 to p1.
Transform read_cylinder_placement(const JsonNode& node) {
    const auto p0 = node.find("p0");
    const auto p1 = node.find("p1");
    const Vec3d from = p0 ? read_vector(*p0) : Vec3d::Zero().eval();
    const Vec3d axis = (p1 ? read_vector(*p1) : Vec3d::UnitZ().eval()) - from;
    if (axis.norm() == 0) node.fail("p0 and p1 of a cylinder must differ");
    const double radius = read_radius(node);
    Transform placement = Transform::Identity();
    placement.linear() = frame_along(axis.normalized()) *
                         Eigen::DiagonalMatrix<double, 3>(radius, radius, axis.norm());
    placement.translation() = from;
    return placement;
}

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
    const JsonNode name = node.at("filename");
    const std::filesystem::path file = read_file_name(name, assets);
    if (lower_case(file.extension().string()) != "." + type)
        name.fail("a shape of type " + type + " takes a ." + type + " file (known: obj, ply)");
    shape.mesh = load_for(name, [&] { return load_mesh(file, options); });
    shape.to_world = keys.to_world;
}

TriangleMesh tessellate(Primitive primitive, const SineHeightfield& field, const CommonKeys& keys) {
    switch (primitive) {
        case Primitive::rectangle: return tessellate_rectangle(keys.cells());
        case Primitive::disk: return tessellate_disk(keys.count(1));
        case Primitive::sphere: return tessellate_sphere(keys.count(2));
        case Primitive::cylinder: return tessellate_cylinder(keys.count(1));
        default: return tessellate_heightfield(field, keys.cells());
    }
}

void read_analytic(const JsonNode& node, const std::string& type, CommonKeys keys, Shape& shape) {
    const std::vector<std::string> names{"rectangle", "disk", "sphere", "cylinder", "heightfield"};
    const auto at = std::ranges::find(names, type) - names.begin();
    shape.primitive = static_cast<Primitive>(at);
    const bool round =
        shape.primitive == Primitive::sphere || shape.primitive == Primitive::cylinder;
    if (round && !keys.resolution && !is_similarity(keys.to_world))
        keys.transform_node->fail("an exact " + type +
                                  " takes rotations, translations and one scale only; give it a "
                                  "`resolution` to stretch it");
    if (shape.primitive == Primitive::sphere)
        keys.to_world = keys.to_world * read_sphere_placement(node);
    if (shape.primitive == Primitive::cylinder)
        keys.to_world = keys.to_world * read_cylinder_placement(node);
    shape.to_world = keys.to_world;
    if (!keys.resolution) {
        shape.flip_normals = keys.flip_normals;
        return;
    }
    shape.mesh = tessellate(shape.primitive, shape.field, keys);
    shape.primitive = Primitive::mesh;
    keys.finish_mesh(shape.mesh);
}

// What is a mesh by its nature.
void set_mesh(TriangleMesh mesh, const CommonKeys& keys, Shape& shape) {
    shape.primitive = Primitive::mesh;
    shape.to_world = keys.to_world;
    shape.mesh = std::move(mesh);
    keys.finish_mesh(shape.mesh);
}

void read_heightfield(const JsonNode& node, const CommonKeys& keys, Shape& shape, Assets& assets) {
    const auto heights = read_heights(node, assets);
    if (const auto* field = std::get_if<SineHeightfield>(&heights)) {
        shape.field = *field;
        return read_analytic(node, "heightfield", keys, shape);
    }
    if (keys.resolution) keys.resolution->fail("the heights have a resolution of their own");
    set_mesh(tessellate_grid(std::get<HeightGrid>(heights)), keys, shape);
}

// What is nested in a shape under keys of the user's choice: a bsdf and an emitter.
void read_nested(const JsonNode& node, Shape& shape, Assets& assets) {
    bool has_bsdf = false;
    const auto children = node.children();
    node.finish();
    for (const auto& [key, child] : children) {
        const std::string type = child.at("type").as_string();
        if (is_bsdf_type(type)) {
            if (has_bsdf) child.fail("a shape takes one bsdf");
            has_bsdf = true;
            shape.bsdf = read_bsdf(child, assets);
            continue;
        }
        std::vector<std::string> known = bsdf_types();
        known.insert(known.begin(), "area");
        read_type(child, "bsdf or emitter", known, {"homogeneous", "heterogeneous"});
        if (shape.radiance) child.fail("a shape takes one emitter");
        shape.radiance = AreaLight::read(child);
        child.finish();
        if (shape.primitive == Primitive::heightfield)
            child.fail("an exact heightfield cannot emit; give it a `resolution`");
    }
}

}  // namespace

const std::vector<std::string>& shape_types() {
    static const std::vector<std::string> types{"rectangle", "disk", "sphere", "cylinder",
                                                "cube",      "obj",  "ply",    "heightfield",
                                                "lathe",     "cut"};
    return types;
}

const std::vector<std::string>& later_shape_types() {
    static const std::vector<std::string> types{"instance", "shapegroup", "bsplinecurve", "sdfgrid",
                                                "serialized"};
    return types;
}

Eigen::AlignedBox3d world_bounds(const Shape& shape) {
    const Eigen::AlignedBox3d local = local_bounds(shape);
    Eigen::AlignedBox3d box;
    for (int i = 0; i < 8; ++i)
        box.extend(shape.to_world * local.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
    return box;
}

Shape read_shape(const std::string& name, const JsonNode& node, Assets& assets) {
    const std::string type = read_type(node, "shape", shape_types(), later_shape_types());
    Shape shape;
    shape.name = name;
    const CommonKeys keys(node, type);
    if (type == "obj" || type == "ply")
        read_mesh_file(node, type, keys, shape, assets);
    else if (type == "cube")
        set_mesh(tessellate_cube(keys.resolution ? keys.count(1) : 1), keys, shape);
    else if (type == "lathe")
        set_mesh(read_lathe(node, keys.resolution ? keys.count(3) : 64), keys, shape);
    else if (type == "cut")
        set_mesh(read_cut(node, keys.resolution), keys, shape);
    else if (type == "heightfield")
        read_heightfield(node, keys, shape, assets);
    else
        read_analytic(node, type, keys, shape);
    const Eigen::AlignedBox3d box = world_bounds(shape);
    require_near(node, {box.min(), box.max()});
    read_nested(node, shape, assets);
    return shape;
}

}  // namespace caustics::scene_file
