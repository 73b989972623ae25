#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/math/frame.h"
#include "experiments/export/exported_scene.h"
#include "experiments/export/mesh_bytes.h"
#include "experiments/export/xml_writer.h"

namespace caustics::experiments {

namespace {

std::string numbers_of(const Eigen::Array3f& v) {
    return fmt::format("{} {} {}", v[0], v[1], v[2]);
}

std::string sixteen(const Eigen::Matrix4d& m) {
    std::string text;
    for (Eigen::Index row = 0; row < 4; ++row)
        for (Eigen::Index column = 0; column < 4; ++column)
            text += fmt::format("{}{}", text.empty() ? "" : " ", m(row, column));
    return text;
}

class MitsubaWriter {
public:
    MitsubaWriter(const SceneDesc& scene, const ExportSettings& settings)
        : scene_(scene), settings_(settings) {}

    ExportedScene write() {
        out_.files.push_back({"scene.xml", {}});
        xml_.open("scene", {{"version", "3.0.0"}});
        write_integrator();
        write_sensor();
        for (const Light& light : scene_.lights) write_emitter(caustics::to_mitsuba(light));
        if (!is_black(scene_.ambient))
            refuse_export(settings_, "an ambient light",
                          "Mitsuba has none (a constant light it has)");
        for (std::size_t i = 0; i < scene_.shapes.size(); ++i) write_shape(i);
        xml_.close();
        out_.files.front().bytes = xml_.text();
        return std::move(out_);
    }

private:
    void write_emitter(const MitsubaEmitter& emitter) {
        xml_.open("emitter", {{"type", emitter.type}});
        if (emitter.to_world) transform("to_world", *emitter.to_world);
        for (const auto& [type, name, given] : emitter.values) {
            if (const auto* numbers = std::get_if<Vec3>(&given))
                value(type, name, numbers_of(*numbers));
            else
                number(name, std::get<double>(given));
        }
        xml_.close();
    }
    void value(const std::string& type, const std::string& name, const std::string& text) {
        xml_.leaf(type, {{"name", name}, {"value", text}});
    }
    void number(const std::string& name, double x) { value("float", name, fmt::format("{}", x)); }
    void transform(const std::string& name, const Eigen::Matrix4d& matrix) {
        xml_.open("transform", {{"name", name}});
        xml_.leaf("matrix", {{"value", sixteen(matrix)}});
        xml_.close();
    }

    // Particles find the caustics of lights without area, which a path never meets.
    void write_integrator() {
        bool casters = false;
        for (const Shape& shape : scene_.shapes) casters = casters || is_caster(shape.bsdf);
        const bool points =
            std::ranges::any_of(scene_.lights, [](const Light& l) { return !has_extent(l); });
        xml_.leaf("default",
                  {{"name", "integrator"}, {"value", casters && points ? "ptracer" : "path"}});
        // Mitsuba counts segments: the specular events, the receiver and the camera. Where nothing is
        // specular, longer paths would add the light between receivers alone.
        const int events = casters ? settings_.max_bounces : 0;
        const std::string longest = std::to_string(events + 2);
        xml_.leaf("default",
                  {{"name", "max_depth"}, {"value", settings_.indirect ? "-1" : longest}});
        xml_.leaf("default",
                  {{"name", "spp"}, {"value", std::to_string(scene_.sampling.sample_count)}});
        xml_.open("integrator", {{"type", "$integrator"}});
        value("integer", "max_depth", "$max_depth");
        // Late roulette: an early one would thin out chains behind a dark receiver.
        const int roulette = std::min(events, preset_bounces) + 2;
        value("integer", "rr_depth",
              settings_.indirect || events > preset_bounces ? std::to_string(roulette)
                                                            : "$max_depth");
        xml_.close();
    }

    void write_sensor() {
        const Camera& camera = scene_.camera;
        Box bounds;
        for (const Shape& shape : scene_.shapes) bounds.extend(caustics::bounds(shape));
        bounds.extend(camera.position());
        const auto size = static_cast<double>(bounds.diagonal().norm());
        xml_.open("sensor", {{"type", "perspective"}});
        value("string", "fov_axis", "x");
        number("fov", 360 / pi_d * std::atan(camera.half_extent().x()));
        number("near_clip", 1e-4 * size);
        number("far_clip", 10 * size);
        transform("to_world", camera.to_world.matrix());
        xml_.open("film", {{"type", "hdrfilm"}});
        value("integer", "width", std::to_string(camera.width));
        value("integer", "height", std::to_string(camera.height));
        value("string", "pixel_format", "rgb");
        value("string", "component_format", "float32");
        xml_.leaf("rfilter", {{"type", "box"}});
        xml_.close();
        write_sampler();
        xml_.close();
    }

    void write_sampler() {
        const PixelSampling& sampling = scene_.sampling;
        if (sampling.max_sample_count > 0)
            out_.notes.emplace_back("Mitsuba has no adaptive sampler: independent samples instead");
        xml_.open("sampler", {{"type", sampling.stratified ? "stratified" : "independent"}});
        value("integer", "sample_count", "$spp");
        // Without jitter Mitsuba takes all random numbers of a pixel, those of its light paths too, from the
        // strata's middles: the same few for each pixel.
        if (sampling.stratified && !sampling.jitter)
            out_.notes.emplace_back(
                "Mitsuba's sampler without jitter would take the same light paths for each pixel: "
                "jittered samples instead");
        xml_.close();
    }

    std::string place(std::size_t i) const { return "/" + scene_.shapes[i].name; }
    [[noreturn]] void refuse(std::size_t i, const std::string& reason) const {
        refuse_export(settings_, place(i), reason);
    }

    void write_shape(std::size_t i) {
        const Shape& shape = scene_.shapes[i];
        const std::string name = plain_name(shape.name, i);
        const bool mesh =
            shape.primitive == Primitive::mesh || shape.primitive == Primitive::heightfield;
        if (mesh)
            open_mesh(shape, name);
        else
            open_exact(i, name);
        if (shape.radiance) {
            xml_.open("emitter", {{"type", "area"}});
            value("rgb", "radiance", numbers_of(*shape.radiance));
            xml_.close();
        }
        write_bsdf(i, name);
        xml_.close();
    }

    void open_mesh(const Shape& shape, const std::string& name) {
        const TriangleMesh mesh = baked_mesh(shape, settings_, out_.notes);
        if (is_caster(shape.bsdf) && !mesh.normals.empty())
            out_.notes.push_back(
                "/" + shape.name +
                ": a caster with vertex normals: Mitsuba weighs what it bends by shading and "
                "geometric normals, this program keeps its flux; they differ by as much as the "
                "normals do (--set /" +
                shape.name + "/face_normals=true makes both the same)");
        out_.files.push_back({name + ".ply", ply_bytes(mesh)});
        xml_.open("shape", {{"type", "ply"}, {"id", name}});
        value("string", "filename", name + ".ply");
        if (mesh.normals.empty()) value("boolean", "face_normals", "true");
    }

    void open_exact(std::size_t i, const std::string& name) {
        const Shape& shape = scene_.shapes[i];
        const bool round = ask_exact(shape, [](const auto& kind) { return kind.needs_similarity; });
        const std::string type = ask_exact(shape, [](const auto& kind) { return kind.type; });
        // Mitsuba turns the normals of a round shape with a negative radius round.
        if (round && shape.to_world.linear().determinant() < 0)
            refuse(i, "Mitsuba turns a mirrored round shape inside out; give it a `resolution`");
        xml_.open("shape", {{"type", type}, {"id", name}});
        transform("to_world", shape.to_world.matrix());
        if (shape.flip_normals) value("boolean", "flip_normals", "true");
    }

    void write_bsdf(std::size_t i, const std::string& name) {
        const Bsdf& bsdf = scene_.shapes[i].bsdf;
        if (bsdf.twosided) xml_.open("bsdf", {{"type", "twosided"}});
        if (bsdf.mirror) {
            const char* const dim =
                ": a mirror in a blend is too dark in Mitsuba 3.9.1, which counts the density "
                "of the other model in its direction: a quarter of a mirror over a grey of 0.5 "
                "keeps about 0.77 of its light there";
            out_.notes.push_back(place(i) + dim);
            xml_.open("bsdf", {{"type", "blendbsdf"}});
            number("weight", static_cast<double>(bsdf.mirror->weight));
        }
        write_model(i, caustics::to_mitsuba(bsdf), name);
        if (bsdf.mirror) {
            write_model(i, Conductor{bsdf.mirror->reflectance}.to_mitsuba(), name);
            xml_.close();
        }
        if (bsdf.twosided) xml_.close();
    }

    void write_model(std::size_t i, const MitsubaBsdf& bsdf, const std::string& shape) {
        if (!bsdf.refused.reason.empty()) refuse(i, with_setting(bsdf.refused, place(i)));
        xml_.open("bsdf", {{"type", bsdf.type}});
        for (const auto& [name, given] : bsdf.values) {
            if (const auto* word = std::get_if<std::string>(&given))
                value("string", name, *word);
            else if (const auto* texture = std::get_if<Texture>(&given))
                write_texture(name, *texture, shape);
            else
                number(name, std::get<double>(given));
        }
        xml_.close();
    }

    void write_texture(const std::string& name, const Texture& texture, const std::string& shape) {
        if (const auto* colour = std::get_if<Spectrum>(&texture)) {
            value("rgb", name, numbers_of(*colour));
        } else if (const auto* board = std::get_if<Checkerboard>(&texture)) {
            xml_.open("texture", {{"name", name}, {"type", "checkerboard"}});
            value("rgb", "color0", numbers_of(board->color0));
            value("rgb", "color1", numbers_of(board->color1));
            transform("to_uv", board->to_uv.matrix().cast<double>());
            xml_.close();
        } else {
            write_bitmap(name, std::get<Bitmap>(texture), shape);
        }
    }

    void write_bitmap(const std::string& name, const Bitmap& bitmap, const std::string& shape) {
        static const char* const filters[] = {"bilinear", "nearest"};
        static const char* const wraps[] = {"repeat", "mirror", "clamp"};
        out_.files.push_back({shape + ".pfm", pfm_bytes(bitmap)});
        xml_.open("texture", {{"name", name}, {"type", "bitmap"}});
        value("string", "filename", shape + ".pfm");
        value("boolean", "raw", "true");
        value("string", "filter_type", filters[static_cast<int>(bitmap.filter)]);
        value("string", "wrap_mode", wraps[static_cast<int>(bitmap.wrap)]);
        transform("to_uv", bitmap.to_uv.matrix().cast<double>());
        xml_.close();
    }

    const SceneDesc& scene_;
    const ExportSettings& settings_;
    XmlWriter xml_;
    ExportedScene out_;
};

}  // namespace

ExportedScene to_mitsuba(const SceneDesc& scene, const ExportSettings& settings) {
    return MitsubaWriter(scene, settings).write();
}

}  // namespace caustics::experiments
