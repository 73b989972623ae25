#include "core/scene_file/shapes.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/geometry/mesh_io.h"
#include "core/geometry/tessellate.h"
#include "core/scene_file/bsdfs.h"
#include "core/scene_file/scene_frame.h"

namespace caustics::scene_file {
namespace {

constexpr double far_away = 1e30;

double read_radius(const JsonNode& node) {
    const auto radius = node.find("radius");
    if (!radius) return 1;
    const double value = radius->as_number_in(0, far_away);
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

SineWave read_wave(const JsonNode& node) {
    SineWave wave;
    wave.amplitude = node.at("amplitude").as_number_in(-far_away, far_away);
    const std::vector<double> k = node.at("wave_vector").as_numbers(2);
    wave.wave_vector = {k[0], k[1]};
    if (wave.wave_vector.cwiseAbs().maxCoeff() > far_away)
        node.at("wave_vector").fail("is out of range (to 1e+30)");
    if (const auto phase = node.find("phase"))
        wave.phase = phase->as_number_in(-far_away, far_away);
    node.finish();
    return wave;
}

SineHeightfield read_heightfield(const JsonNode& node) {
    for (const char* later : {"fractal", "filename", "grid"})
        if (node.has(later))
            node.at(later).fail(std::string("heightfield by ") + later +
                                " is not supported (yet) (known: waves)");
    SineHeightfield field;
    for (const JsonNode& wave : node.at("waves").as_array()) field.waves.push_back(read_wave(wave));
    if (const auto half_size = node.find("half_size")) {
        const std::vector<double> half = half_size->as_numbers(2);
        for (const JsonNode& side : half_size->as_array()) side.as_number_in(0, far_away);
        if (half[0] <= 0 || half[1] <= 0) half_size->fail("must be above 0");
        field.half_size = {half[0], half[1]};
    }
    return field;
}

bool is_similarity(const Transform& transform) {
    const Eigen::Matrix3d square = transform.linear().transpose() * transform.linear();
    const double scale = square.trace() / 3;
    return (square - scale * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= 1e-6 * scale;
}

TriangleMesh tessellate(Primitive primitive, const SineHeightfield& field, int n) {
    switch (primitive) {
        case Primitive::rectangle: return tessellate_rectangle(n);
        case Primitive::disk: return tessellate_disk(n);
        case Primitive::sphere: return tessellate_sphere(n);
        case Primitive::cylinder: return tessellate_cylinder(n);
        default: return tessellate_heightfield(field, n);
    }
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
        if (file && node.has("resolution"))
            node.at("resolution")
                .fail("a mesh file has its own resolution; only analytic shapes take one");
        if (!file) resolution = node.find("resolution");
        const auto faces = node.find("face_normals");
        if (faces && !file && !resolution && type != "cube")
            faces->fail("only a mesh has face normals; give the shape a `resolution`");
        if (faces) face_normals = faces->as_bool();
    }

    int count(int least) const { return static_cast<int>(resolution->as_integer_in(least, 4096)); }

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
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension != "." + type)
        name.fail("a shape of type " + type + " takes a ." + type + " file (known: obj, ply)");
    shape.mesh = load_for(name, [&] { return load_mesh(file, options); });
    shape.to_world = keys.to_world;
}

void read_analytic(const JsonNode& node, const std::string& type, CommonKeys keys, Shape& shape) {
    const std::vector<std::string> names{"rectangle", "disk", "sphere", "cylinder", "heightfield"};
    const auto at = std::ranges::find(names, type) - names.begin();
    shape.primitive = static_cast<Primitive>(at);
    if (shape.primitive == Primitive::heightfield) shape.field = read_heightfield(node);
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
    const int n = keys.count(shape.primitive == Primitive::sphere ? 2 : 1);
    shape.mesh = tessellate(shape.primitive, shape.field, n);
    shape.primitive = Primitive::mesh;
    keys.finish_mesh(shape.mesh);
}

void read_cube(const CommonKeys& keys, Shape& shape) {
    shape.primitive = Primitive::mesh;
    shape.to_world = keys.to_world;
    shape.mesh = tessellate_cube(keys.resolution ? keys.count(1) : 1);
    keys.finish_mesh(shape.mesh);
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
        read_type(child, "bsdf or emitter",
                  {"area", "diffuse", "schlick", "phong", "dielectric", "conductor", "blendbsdf",
                   "twosided"},
                  {"homogeneous", "heterogeneous"});
        if (shape.radiance) child.fail("a shape takes one emitter");
        shape.radiance = read_colour(child, "radiance", 1, far_away);
        child.finish();
        if (shape.primitive == Primitive::heightfield)
            child.fail("an exact heightfield cannot emit; give it a `resolution`");
    }
}

}  // namespace

const std::vector<std::string>& shape_types() {
    static const std::vector<std::string> types{"rectangle", "disk", "sphere", "cylinder",
                                                "cube",      "obj",  "ply",    "heightfield"};
    return types;
}

const std::vector<std::string>& later_shape_types() {
    static const std::vector<std::string> types{"lathe",        "instance", "shapegroup",
                                                "bsplinecurve", "sdfgrid",  "serialized"};
    return types;
}

Shape read_shape(const std::string& name, const JsonNode& node, Assets& assets) {
    const std::string type = read_type(node, "shape", shape_types(), later_shape_types());
    Shape shape;
    shape.name = name;
    const CommonKeys keys(node, type);
    if (type == "obj" || type == "ply")
        read_mesh_file(node, type, keys, shape, assets);
    else if (type == "cube")
        read_cube(keys, shape);
    else
        read_analytic(node, type, keys, shape);
    const Eigen::AlignedBox3d box = world_bounds(shape);
    require_near(node, {box.min(), box.max()});
    read_nested(node, shape, assets);
    return shape;
}

}  // namespace caustics::scene_file
