#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/export/exported_scene.h"

namespace caustics::experiments {

namespace {

template <class Vector>
std::string vector_of(const Vector& v) {
    return fmt::format("<{}, {}, {}>", v[0], v[1], v[2]);
}

std::string matrix(const Transform& to_world) {
    std::string text;
    for (Eigen::Index column = 0; column < 4; ++column)
        for (Eigen::Index row = 0; row < 3; ++row)
            text += fmt::format("{}{}", text.empty() ? "" : ", ", to_world.matrix()(row, column));
    return "matrix <" + text + ">";
}

const Checkerboard* checkerboard(const PovraySurface& surface) {
    return surface.pigment ? std::get_if<Checkerboard>(&*surface.pigment) : nullptr;
}

// POV-Ray tells things apart that are 0.001 to 0.0001 of its units apart, and fails where coordinates come to
// some 10,000: a power of ten of units a metre for which the scene is 300 to 3000 units wide.
double units_a_metre(const Scene& scene) {
    const auto wide = static_cast<double>(scene.diameter());
    return wide > 0 ? std::pow(10.0, std::floor(std::log10(3000 / wide))) : 1;
}

bool is_glass(const Shape& shape) { return to_povray(shape.bsdf).interior.has_value(); }

// A list of a mesh2 object, one item a line.
template <class Items, class Text>
std::string mesh_list(const char* name, const Items& items, const Text& text) {
    std::string list = fmt::format("  {} {{ {}", name, items.size());
    for (const auto& item : items) list += ",\n    " + text(item);
    return list + " }\n";
}

std::string mesh2(const TriangleMesh& mesh, const Checkerboard* board) {
    std::string text = "mesh2 {\n";
    text += mesh_list("vertex_vectors", mesh.positions, [](const Vec3& p) { return vector_of(p); });
    if (!mesh.normals.empty())
        text +=
            mesh_list("normal_vectors", mesh.normals, [](const Vec3& n) { return vector_of(n); });
    if (board != nullptr)
        text += mesh_list("uv_vectors", mesh.uvs, [board](const Vec2& uv) {
            const Vec3 placed = board->to_uv * Vec3(uv.x(), uv.y(), 0);
            return fmt::format("<{}, {}>", placed.x(), placed.y());
        });
    // POV-Ray's flat triangles turn their front to where their corners run clockwise.
    text += mesh_list("face_indices", mesh.triangles,
                      [](const auto& t) { return fmt::format("<{}, {}, {}>", t[0], t[2], t[1]); });
    return text;
}

// An exact shape in POV-Ray's words; nullptr: it is written as a mesh.
const char* words_of(const Shape& shape) {
    if (shape.primitive == Primitive::mesh) return nullptr;
    return ask_exact(shape, [](const auto& kind) { return kind.povray; });
}

class PovrayWriter {
public:
    PovrayWriter(const SceneDesc& scene, const ExportSettings& settings)
        : scene_(scene), settings_(settings), world_(scene), unit_(units_a_metre(world_)) {}

    ExportedScene write() {
        check_insides();
        text_ = fmt::format(
            "#version 3.7;\n"
            "// Lengths are metres times this: POV-Ray's tolerances are lengths.\n"
            "#declare Unit = {};\n",
            unit_);
        write_settings();
        write_camera();
        for (const Light& light : scene_.lights)
            write_light(caustics::to_povray(light, world_.surroundings()));
        for (const Shape& shape : scene_.shapes) write_shape(shape);
        out_.files = {{"scene.ini", ini()}, {"scene.pov", text_}};
        return std::move(out_);
    }

private:
    [[noreturn]] void refuse(const Shape& shape, const std::string& reason) const {
        refuse_export(settings_, "/" + shape.name, reason);
    }

    // POV-Ray takes a ray's first meeting with a surface for the way into it, so that a dielectric
    // without an outside all round is right only when seen from outside.
    void check_from_outside(const Ray& ray, const std::string& who) const {
        const auto hit = world_.intersect(ray);
        if (!hit || hit->geometric_normal.dot(ray.direction) <= 0) return;
        const Shape& shape = world_.shape_at(*hit);
        if (is_glass(shape) && shape.primitive != Primitive::sphere)
            refuse(shape, "POV-Ray takes the first meeting with a dielectric for the way in, but " +
                              who + " looks at this one from inside");
    }

    void check_insides() const {
        const Camera& camera = scene_.camera;
        for (int y = 0; y < camera.height; ++y)
            for (int x = 0; x < camera.width; ++x)
                check_from_outside({camera.position(), camera.direction(x + 0.5, y + 0.5)},
                                   "the camera");
        constexpr int rays = 4096;
        const double golden_angle = pi_d * (3 - std::sqrt(5.0));
        for (const Light& light : scene_.lights) {
            const auto point = point_of(light);
            for (int i = 0; i < rays && point && point->position; ++i) {
                const double z = 1 - (2 * i + 1.0) / rays;
                const double r = std::sqrt(1 - z * z);
                const Vec3d direction(r * std::cos(i * golden_angle),
                                      r * std::sin(i * golden_angle), z);
                check_from_outside({*point->position, direction.cast<float>()}, "a light");
            }
        }
    }

    // POV-Ray takes 256 at most, and POV-Ray 3.7 ends by SIGSEGV near that: a ball of glass did, with many photons.
    int trace_level(int more) const { return std::min(settings_.max_bounces + more, 64); }
    // POV-Ray follows all branches, of which there would be too many without a least weight.
    const char* least_weight() const {
        return settings_.max_bounces > preset_bounces ? "0.0001" : "0";
    }

    void write_settings() {
        const bool casters = !world_.casters().empty();
        text_ += fmt::format(
            "global_settings {{\n  assumed_gamma 1.0\n  ambient_light rgb {}\n"
            "  max_trace_level {}\n  adc_bailout {}\n",
            is_black(scene_.ambient) ? "0" : vector_of(scene_.ambient), trace_level(2),
            least_weight());
        if (casters)
            text_ += fmt::format(
                "  #ifndef (Photon_Count) #declare Photon_Count = 200000; #end\n"
                "  #ifndef (Photon_Gather) #declare Photon_Gather = 100; #end\n"
                "  photons {{\n    count Photon_Count\n"
                "    #ifdef (Photon_Radius) radius Photon_Radius * Unit gather 0, 1000000\n"
                "    #else gather 20, Photon_Gather #end\n"
                "    autostop 1\n    max_trace_level {}\n    adc_bailout {}\n  }}\n",
                trace_level(1), least_weight());
        if (settings_.indirect) write_radiosity();
        text_ += "}\n";
    }

    // POV-Ray's irradiance cache [Ward et al. 1988], finer than its default; 20 is its longest path.
    void write_radiosity() {
        text_ +=
            "  #ifndef (Radiosity_Count) #declare Radiosity_Count = 400; #end\n"
            "  #ifndef (Radiosity_Error) #declare Radiosity_Error = 0.3; #end\n"
            "  radiosity {\n    count Radiosity_Count\n    error_bound Radiosity_Error\n"
            "    nearest_count 10\n    low_error_factor 0.7\n    recursion_limit 20\n"
            "    pretrace_start 0.08\n    pretrace_end 0.01\n    gray_threshold 0\n"
            "    brightness 1\n    always_sample off\n  }\n";
        out_.notes.emplace_back(
            "POV-Ray interpolates the light between receivers among few points (radiosity; "
            "Radiosity_Count and Radiosity_Error set how many)");
    }

    void write_camera() {
        const Camera& camera = scene_.camera;
        const Eigen::Matrix3d axes = camera.to_world.linear();
        const Vec2d extent = 2 * camera.half_extent();
        // +x of the camera is the picture's left.
        text_ += fmt::format(
            "camera {{\n  perspective\n  location {} * Unit\n  right {}\n  up {}\n  direction "
            "{}\n}}\n",
            vector_of(Vec3d(camera.to_world.translation())),
            vector_of(Vec3d(-extent.x() * axes.col(0))), vector_of(Vec3d(extent.y() * axes.col(1))),
            vector_of(Vec3d(axes.col(2))));
    }

    void write_light(const PovrayLight& light) {
        if (!light.refused.empty()) refuse_export(settings_, light.name, light.refused);
        text_ += fmt::format("light_source {{\n  {} * Unit, rgb {}\n", vector_of(light.from),
                             vector_of(light.colour));
        if (light.fade_distance)
            text_ +=
                fmt::format("  fade_distance {} * Unit\n  fade_power 2\n", *light.fade_distance);
        if (light.point_at)
            text_ += fmt::format("  parallel\n  point_at {} * Unit\n", vector_of(*light.point_at));
        text_ += "  photons { reflection on refraction on }\n}\n";
    }

    void write_shape(const Shape& shape) {
        if (shape.radiance)
            refuse(shape,
                   "POV-Ray's area lights are points on a grid without Lambert's cosine; export "
                   "scenes with point or directional lights");
        const PovraySurface surface = caustics::to_povray(shape.bsdf);
        if (!surface.refused.reason.empty())
            refuse(shape, with_setting(surface.refused, "/" + shape.name));
        if (shape.bsdf.mirror && !surface.highlight.empty())
            refuse(shape, "a blend of phong and a conductor is not exported to POV-Ray");
        text_ += fmt::format("// {}\n", plain_name(shape.name, 0));
        write_geometry(shape, checkerboard(surface));
        text_ += "  scale Unit\n";
        note_size(shape);
        if (surface.interior)
            write_glass(shape, *surface.interior);
        else
            write_opaque(shape, surface);
        text_ += "}\n";
    }

    void write_geometry(const Shape& shape, const Checkerboard* board) {
        const char* const exact = words_of(shape);
        if (exact != nullptr && board == nullptr) {
            text_ += fmt::format("{}\n  {}\n", exact, matrix(shape.to_world));
            return;
        }
        if (exact != nullptr)
            refuse(shape,
                   "POV-Ray's texture coordinates of exact round shapes are others; give the "
                   "shape a `resolution`");
        // Two triangles are a rectangle exactly.
        ExportSettings settings = settings_;
        if (shape.primitive == Primitive::rectangle) settings.mesh_resolution = 1;
        std::vector<std::string> unsaid;
        text_ += mesh2(baked_mesh(shape, settings,
                                  shape.primitive == Primitive::rectangle ? unsaid : out_.notes),
                       board);
    }

    void note_size(const Shape& shape) {
        constexpr double coarse = 0.1;  // units: 1 % are lost of it
        const auto wide = static_cast<double>(bounds(shape).diagonal().norm());
        if (unit_ * wide < coarse)
            out_.notes.push_back(
                fmt::format("/{}: POV-Ray's tolerance, {:.2g} m beside so wide a scene, is {:.2g} "
                            "% of its width of {:.2g} m",
                            shape.name, 1e-3 / unit_, 0.1 / (unit_ * wide), wide));
    }

    std::string pigment(const Shape& shape, const PovraySurface& surface) const {
        if (!surface.pigment) return "pigment { rgb 0 }";
        if (const auto* colour = std::get_if<Spectrum>(&*surface.pigment))
            return fmt::format("pigment {{ rgb {} }}", vector_of(*colour));
        const Checkerboard* board = checkerboard(surface);
        if (board == nullptr)
            refuse(shape, "bitmap textures are not exported to POV-Ray; give the shape one colour");
        return fmt::format("uv_mapping pigment {{ checker color rgb {}, color rgb {} scale 0.5 }}",
                           vector_of(board->color0), vector_of(board->color1));
    }

    // With the mirror of a blend.
    static std::string finish(const PovraySurface& surface,
                              const std::optional<MirrorPart>& mirror) {
        const float diffuse = mirror ? 1 - mirror->weight : surface.diffuse;
        const std::optional<Spectrum> reflection =
            mirror ? Spectrum(mirror->weight * mirror->reflectance) : surface.reflection;
        return fmt::format(
            "finish {{ ambient {} diffuse {}{}{} }}", diffuse, diffuse, surface.highlight,
            reflection ? fmt::format(" reflection {{ rgb {} }}", vector_of(*reflection)) : "");
    }

    // One-sided surfaces are black from behind.
    void write_opaque(const Shape& shape, const PovraySurface& surface) {
        const std::string black = "pigment { rgb 0 } finish { ambient 0 diffuse 0 }";
        const std::string seen = pigment(shape, surface) + " " + finish(surface, shape.bsdf.mirror);
        const bool inverted = shape.flip_normals && words_of(shape) != nullptr;
        const bool both = shape.bsdf.twosided;
        text_ += fmt::format("  texture {{ {} }}\n", inverted && !both ? black : seen);
        if (!both) text_ += fmt::format("  interior_texture {{ {} }}\n", inverted ? seen : black);
        if (is_caster(shape.bsdf))
            text_ += fmt::format("  photons {{ target reflection on refraction off{} }}\n",
                                 is_receiver(shape.bsdf) ? "" : " collect off");
    }

    void check_glass(const Shape& shape, const PovrayInterior& glass) {
        if (!is_black(glass.absorption) && shape.primitive != Primitive::sphere)
            refuse(shape,
                   "POV-Ray absorbs light only between two surfaces of one object, not "
                   "from water to its floor; set absorption 0, such as --set /" +
                       shape.name + "/bsdf/absorption=0");
        if (shape.flip_normals && shape.primitive == Primitive::sphere)
            refuse(shape, "POV-Ray's spheres have their medium inside; leave flip_normals away");
        if (ext_ior_ && *ext_ior_ != glass.outside)
            refuse(shape,
                   "POV-Ray has one medium outside of all dielectrics; give all the same "
                   "ext_ior");
        ext_ior_ = glass.outside;
    }

    void write_glass(const Shape& shape, const PovrayInterior& glass) {
        check_glass(shape, glass);
        text_ +=
            "  texture { pigment { rgbt 1 } finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel "
            "on } conserve_energy } }\n";
        text_ += fmt::format("  interior {{ ior {}", glass.ior);
        if (glass.dispersion) {
            text_ += fmt::format(" dispersion {} dispersion_samples 16", *glass.dispersion);
            out_.notes.push_back(
                "/" + shape.name +
                ": POV-Ray spreads colours evenly between violet and red: where light "
                "falls compares, its colours do not");
        }
        // Fading of power 1000 and above is exp(-(1 - fade_color) d / fade_distance).
        if (const float most = glass.absorption.maxCoeff(); most > 0)
            text_ += fmt::format(" fade_distance {} * Unit fade_power 1001 fade_color rgb {}",
                                 1 / most, vector_of(Spectrum(1 - glass.absorption / most)));
        text_ += " }\n  photons { target reflection on refraction on collect off }\n";
    }

    std::string ini() {
        constexpr int finest = 9;
        int root = static_cast<int>(std::lround(std::sqrt(scene_.sampling.sample_count)));
        if (root > finest) {
            root = finest;
            out_.notes.emplace_back("POV-Ray takes at most 81 rays a pixel");
        }
        std::string text = fmt::format(
            "Input_File_Name=scene.pov\nOutput_File_Name=scene.exr\nOutput_File_Type=E\n"
            "Output_Alpha=Off\nDisplay=Off\nWidth={}\nHeight={}\n",
            scene_.camera.width, scene_.camera.height);
        // Threshold 0: every pixel, not only the edges.
        if (root > 1)
            text += fmt::format(
                "Antialias=On\nSampling_Method=1\nAntialias_Threshold=0.0\nAntialias_Depth={}\n"
                "Antialias_Gamma=1.0\nJitter=Off\n",
                root);
        return text;
    }

    const SceneDesc& scene_;
    const ExportSettings& settings_;
    Scene world_;
    double unit_;  ///< of POV-Ray, a metre
    std::optional<Ior> ext_ior_;
    std::string text_;
    ExportedScene out_;
};

}  // namespace

ExportedScene to_povray(const SceneDesc& scene, const ExportSettings& settings) {
    return PovrayWriter(scene, settings).write();
}

}  // namespace caustics::experiments
