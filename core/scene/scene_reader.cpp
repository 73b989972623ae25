#include "core/scene/scene_reader.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/atomic_file.h"
#include "core/base/hash.h"
#include "core/base/lower_case.h"
#include "core/lights/ambient_light.h"
#include "core/material/bsdf_reader.h"
#include "core/scene/scene_frame.h"
#include "core/scene/shape_reader.h"
#include "core/scene_file/json_reader.h"
#include "core/scene_file/values.h"

namespace caustics {
namespace {

using scene_file::Assets;
using scene_file::read_colour;
using scene_file::read_type;
using scene_file::read_vector;
using scene_file::unlimited;

void read_film(const JsonNode& node, Camera& camera) {
    if (const auto width = node.find("width"))
        camera.width = static_cast<int>(width->as_integer_in(1, 65536));
    if (const auto height = node.find("height"))
        camera.height = static_cast<int>(height->as_integer_in(1, 65536));
    // A film's planes are held whole in memory.
    constexpr double most_pixels = 1 << 27;
    if (double{1} * camera.width * camera.height > most_pixels)
        node.fail("width times height is more than 134217728 pixels");
    const auto filters = node.children();
    node.finish();
    for (const auto& [key, filter] : filters) {
        read_type(filter, "reconstruction filter", {"box"},
                  {"gaussian", "tent", "mitchell", "catmullrom", "lanczos"});
        filter.finish();
    }
    if (filters.size() > 1) node.fail("a film takes one reconstruction filter");
}

// Of files. Faint reflections of glass that are left to roulette are specks at few samples a pixel.
PixelSampling usual_sampling() {
    PixelSampling sampling;
    sampling.split_depth = 2;
    return sampling;
}

PixelSampling read_sampler(const JsonNode& node, const std::string& type) {
    PixelSampling sampling = usual_sampling();
    sampling.stratified = type == "stratified";
    const auto count = node.find("sample_count");
    if (count) sampling.sample_count = static_cast<int>(count->as_integer_in(1, 1 << 20));
    if (sampling.stratified) {
        if (const auto jitter = node.find("jitter")) sampling.jitter = jitter->as_bool();
        const int root = static_cast<int>(std::floor(std::sqrt(sampling.sample_count)));
        if (root * root != sampling.sample_count)
            count->fail(std::to_string(sampling.sample_count) +
                        " is no square number, which a stratified sampler takes (" +
                        std::to_string(root * root) + " or " +
                        std::to_string((root + 1) * (root + 1)) + ")");
    }
    if (const auto depth = node.find("split_depth"))
        sampling.split_depth =
            static_cast<int>(depth->as_integer_in(0, PixelSampling::most_split_depth));
    if (type == "adaptive") {
        const auto most = node.find("max_sample_count");
        sampling.max_sample_count =
            most ? static_cast<int>(most->as_integer_in(1, 1 << 20)) : 32 * sampling.sample_count;
        if (sampling.sample_count < 2)
            node.fail("adaptive sampling starts with at least 2 samples (sample_count)");
        if (most && sampling.max_sample_count < sampling.sample_count)
            most->fail("must not be below sample_count (" + std::to_string(sampling.sample_count) +
                       ")");
        if (const auto error = node.find("max_error")) {
            sampling.max_error = static_cast<float>(error->as_number_in(0, unlimited));
            if (!(sampling.max_error > 0)) error->fail("must be above 0");
        }
    }
    node.finish();
    return sampling;
}

void read_sensor(const JsonNode& node, SceneDesc& desc) {
    read_type(node, "sensor", {"perspective"},
              {"thinlens", "orthographic", "radiancemeter", "irradiancemeter", "distant"});
    Camera& camera = desc.camera;
    if (const auto fov = node.find("fov")) {
        camera.fov_degrees = fov->as_number_in(0, 180);
        if (camera.fov_degrees < 1e-6 || camera.fov_degrees > 179.9999)
            fov->fail("must lie between 1e-6 and 179.9999 degrees");
    }
    if (const auto axis = node.find("fov_axis"))
        camera.fov_axis = static_cast<Camera::FovAxis>(
            axis->as_choice({"x", "y", "diagonal", "smaller", "larger"}));
    if (const auto to_world = node.find("to_world")) {
        camera.to_world = scene_file::read_transform(*to_world);
        // A view is a direction: a scale changes nothing, a shear or a mirror is a mistake.
        const Eigen::Matrix3d linear = camera.to_world.linear();
        const Eigen::Matrix3d square = linear.transpose() * linear;
        const double scale = square.trace() / 3;
        const bool skewed =
            (square - scale * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-6 * scale;
        if (skewed || linear.determinant() < 0)
            to_world->fail("a sensor takes rotations, translations and one positive scale only");
        camera.to_world.linear() = linear / std::sqrt(scale);
        scene_file::require_near(*to_world, {camera.to_world.translation()});
    }
    desc.sampling = usual_sampling();
    bool has_film = false;
    bool has_sampler = false;
    const auto children = node.children();
    node.finish();
    for (const auto& [key, child] : children) {
        const std::string type = read_type(child, "film or sampler",
                                           {"hdrfilm", "independent", "stratified", "adaptive"},
                                           {"specfilm", "multijitter", "orthogonal", "ldsampler"});
        bool& seen = type == "hdrfilm" ? has_film : has_sampler;
        if (seen) child.fail("stands twice: a sensor takes one film and one sampler");
        seen = true;
        if (type == "hdrfilm")
            read_film(child, camera);
        else
            desc.sampling = read_sampler(child, type);
    }
}

// What is read before it is known where the scene's frame lies.
struct Draft {
    SceneDesc desc;
    std::vector<JsonNode> shape_nodes;
    std::vector<std::pair<std::string, JsonNode>> light_nodes;  // by type
    bool has_sensor = false;
    Assets assets;
};

// Types of a scene's children.
const std::vector<std::string>& child_types() {
    static const std::vector<std::string> types = [] {
        std::vector<std::string> all{"perspective"};
        std::ranges::copy(light_types(), std::back_inserter(all));
        all.emplace_back("ambient");
        std::ranges::copy(scene_file::shape_types(), std::back_inserter(all));
        return all;
    }();
    return types;
}

const std::vector<std::string>& later_child_types() {
    static const std::vector<std::string> types = [] {
        std::vector<std::string> all{"envmap",      "projector", "directionalarea",
                                     "sunsky",      "thinlens",  "orthographic",
                                     "homogeneous", "ref",       "heterogeneous"};
        std::ranges::copy(scene_file::later_shape_types(), std::back_inserter(all));
        return all;
    }();
    return types;
}

bool is_integrator(const std::string& type) {
    static const std::vector<std::string> types{"path",   "volpath", "direct", "ptracer",
                                                "moment", "aov",     "depth",  "photonmapper"};
    return std::ranges::find(types, type) != types.end();
}

// The children of the scene differ by their types alone.
void read_child(const std::string& key, const JsonNode& node, Draft& draft) {
    const std::string type = lower_case(node.at("type").as_string());
    if (is_integrator(type))
        node.fail(
            "integrators are not supported: the method is chosen on the command line or in "
            "the sweep, not in the scene");
    if (type == "area") node.fail("an area emitter is nested in the shape that emits");
    if (scene_file::is_bsdf_type(type) && type != "ref")
        node.fail("a bsdf is nested in the shape that has it; share one by $include");
    read_type(node, "scene object", child_types(), later_child_types());
    if (type == "ambient") {
        draft.desc.ambient += AmbientLight::read(node);
        return node.finish();
    }
    if (std::ranges::find(light_types(), type) != light_types().end()) {
        draft.light_nodes.emplace_back(type, node);
        return;
    }
    if (type != "perspective") {
        draft.desc.shapes.push_back(scene_file::make_for(
            node, [&] { return scene_file::read_shape(key, node, draft.assets); }));
        draft.shape_nodes.push_back(node);
        return;
    }
    if (draft.has_sensor) node.fail("a scene takes one sensor");
    draft.has_sensor = true;
    read_sensor(node, draft.desc);
}

SceneDesc placed(Draft& draft) {
    SceneDesc& desc = draft.desc;
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const Shape& shape : desc.shapes) boxes.push_back(scene_file::world_bounds(shape));
    desc.origin = scene_file::frame_origin(desc.shapes, boxes);
    for (std::size_t i = 0; i < desc.shapes.size(); ++i) {
        if (!scene_file::is_resolved(boxes[i], desc.origin))
            draft.shape_nodes[i].fail(
                fmt::format("is {:.3g} m wide and {:.3g} m from the scene's casters: floats do not "
                            "resolve what is a million times as far as it is wide",
                            boxes[i].diagonal().norm(), (boxes[i].center() - desc.origin).norm()));
        scene_file::load_for(draft.shape_nodes[i],
                             [&] { scene_file::place(desc.shapes[i], desc.origin); });
    }
    bool is_surrounded = false;
    for (const auto& [type, node] : draft.light_nodes) {
        desc.lights.push_back(read_light(type, node, desc.origin));
        if (!surrounds(desc.lights.back())) continue;
        if (is_surrounded) node.fail("a scene takes one constant light");
        is_surrounded = true;
    }
    desc.camera.to_world.pretranslate(-desc.origin);
    return std::move(desc);
}

}  // namespace

SceneFile load_scene(const std::filesystem::path& file, const Overrides& overrides,
                     PictureDepth textures) {
    JsonNode root = JsonNode::parse_file(file);
    for (const auto& [pointer, value] : overrides) root.set(pointer, value);
    if (const auto type = root.find("type")) type->as_choice({"scene"});
    if (const auto version = root.find("version")) version->as_integer_in(1, 1);
    Draft draft;
    draft.assets.textures = textures;
    const auto children = root.children();
    root.finish();
    draft.desc.shapes.reserve(children.size());
    for (const auto& [key, child] : children) read_child(key, child, draft);
    if (!draft.has_sensor) root.fail("the scene has no sensor (known: perspective)");
    if (draft.desc.shapes.empty()) root.fail("the scene has no shape");
    SceneFile scene;
    scene.desc = placed(draft);
    scene.canonical = root.canonical();
    scene.files = root.files();
    std::uint64_t state = fnv1a(scene.canonical);
    for (const auto& [path, name] : draft.assets.files) {
        scene.files.push_back(path);
        scene.assets.emplace_back(name, hex(fnv1a(read_whole_file(path))));
        state = fnv1a(name + scene.assets.back().second, state);
    }
    scene.hash = hex(state);
    return scene;
}

}  // namespace caustics
