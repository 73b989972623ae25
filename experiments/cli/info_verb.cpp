#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "core/light_path/aimed_emission.h"
#include "core/light_path/bounce_limit.h"
#include "core/lights/light_text.h"
#include "core/picture/exr_file.h"
#include "core/picture/png_file.h"
#include "core/scene/transport_hash.h"
#include "experiments/base/environment.h"
#include "experiments/base/file_io.h"
#include "experiments/base/number_option.h"
#include "experiments/base/signals.h"
#include "experiments/base/status_line.h"
#include "experiments/cli/map_info.h"
#include "experiments/cli/shape_lines.h"
#include "experiments/cli/verbs.h"
#include "experiments/picture/beam_picture.h"
#include "experiments/picture/previews.h"
#include "experiments/run/caustic_ledger.h"
#include "experiments/run/cli_options.h"
#include "experiments/run/cost_forecast.h"
#include "experiments/run/notes.h"
#include "experiments/run/run_progress.h"
#include "experiments/run/written_files.h"

namespace caustics::experiments {

namespace {

constexpr std::uint64_t sampled_paths = 20'000;  ///< of the light that casters send on

std::string sampling_name(const PixelSampling& sampling) {
    if (sampling.max_sample_count > 0)
        return fmt::format("adaptive to {}, error {:g}", sampling.max_sample_count,
                           sampling.max_error);
    if (!sampling.stratified) return "independent";
    return sampling.jitter ? "stratified" : "regular";
}

// Of how much of its work, where that is not all.
std::string judged_by(const BuildReport& report) {
    if (const auto events = report.resolved.find("events_by_beams");
        events != report.resolved.end())
        return events->second > 0
                   ? fmt::format(
                         ", by beams of up to {:g} event{} with {:.1f} % of the caustic, "
                         "and by pencils for any other",
                         events->second, events->second > 1 ? "s" : "",
                         100 * report.resolved.at("beam_share"))
                   : ", by pencils, for beams would take many times a photon map's time";
    const auto sampled = report.counters.find("polygons_sampled");
    if (sampled == report.counters.end()) return "";
    return fmt::format(", by a sample of {} polygons of {}", sampled->second,
                       report.counters.at("polygons"));
}

/// Costs of pictures by the methods' defaults, from the start of a command.
class Costs {
public:
    explicit Costs(const Scene& scene) : forecast_(scene, scene.sampling().sample_count) {}

    std::string text(const Method& method, const Serving& serving) const {
        const auto polygons = serving.report.counters.find("polygons");
        try {
            return text(forecast_.of(
                method, polygons == serving.report.counters.end() ? 0 : polygons->second));
        } catch (const UnsupportedScene& refusal) {
            return fmt::format(", but a trial is refused ({})", refusal.what());
        } catch (const InputError& refusal) {
            return fmt::format(", but a trial is refused ({})", refusal.what());
        }
    }

private:
    std::string text(const PictureCost& cost) const {
        return fmt::format(", {}{:.2g} CPU s and {:.0f} MB", cost.is_least ? "at least " : "",
                           loading_ + cost.seconds, (loaded_ + cost.bytes) / 1e6);
    }

    double loading_ = cpu_seconds_used();
    double loaded_ = static_cast<double>(resident_bytes());
    CostForecast forecast_;
};

std::string methods_text(const Scene& scene, bool is_quick) {
    std::string text = "methods";
    if (!is_quick) text += ", and what a picture by their defaults takes";
    if (!is_quick && scene.sampling().max_sample_count > 0) text += " without adaptive samples";
    text += "\n";
    std::optional<Costs> costs;
    if (!is_quick) costs.emplace(scene);
    StatusLine asked;
    for (const std::string& name : method_names()) {
        if (asked.is_on_terminal()) asked.show(fmt::format("asking {} ...", name));
        const Method method = parse_method(name, parameters_node({}));
        const Serving serving = try_serving(scene, method);
        text += fmt::format("  {:<16} ", name);
        if (serving.why_not)
            text += "no: " + *serving.why_not + "\n";
        else
            text += "yes" + (costs ? costs->text(method, serving) : "") +
                    judged_by(serving.report) + "\n";
    }
    return text;
}

std::string describe_scene(const SceneOptions& options, const SceneFile& file, const Scene& scene,
                           bool is_quick) {
    std::string text = fmt::format("scene    {}\nhash     {}\n", one_line(options.file), file.hash);
    for (const auto& [name, hash] : file.assets)
        text += fmt::format("asset    {} ({})\n", one_line(name), hash);
    text += fmt::format("photons  of maps with transport {}, of global maps with {}\n",
                        hex(transport_hash(scene)), hex(whole_transport_hash(scene)));
    text += fmt::format("diameter {:.6g} m\n", scene.diameter());
    if (const Vec3d& o = scene.origin(); !o.isZero(0))
        text +=
            fmt::format("frame    coordinates are kept relative to ({:.9g}, {:.9g}, {:.9g}) m\n",
                        o.x(), o.y(), o.z());
    const PixelSampling& sampling = scene.sampling();
    text += fmt::format("film     {} x {} pixels, {} samples a pixel, {}\n", scene.camera().width,
                        scene.camera().height, sampling.sample_count, sampling_name(sampling));
    text += "shapes\n";
    const std::vector<ExaminedMesh> meshes = examine_meshes(scene);
    for (const std::string& line : shape_lines(scene, meshes)) text += line;
    text += "lights\n";
    for (const Light& light : scene.lights())
        text += "  " + line_of(light, scene.surroundings(), scene.origin()) + "\n";
    if (!is_black(scene.ambient()))
        text += fmt::format("  ambient, radiance {} W/(m^2 sr)\n", rgb(scene.ambient()));
    const AimedEmission emission(scene);
    const bool has_spot = std::ranges::any_of(scene.lights(), [](const Light& light) {
        return std::holds_alternative<SpotLight>(light);
    });
    text += fmt::format("  power aimed at the casters' bounds: {} W{}\n",
                        rgb(emission.empty() ? black() : emission.total_power()),
                        has_spot ? " (of spots as if they had no falloff)" : "");
    for (const std::string& line :
         lines_of(scene, survey_light(scene, most_bounces, sampled_paths)))
        text += "  " + line + "\n";
    text += methods_text(scene, is_quick);
    for (const std::string& note : mesh_notes(scene, meshes)) text += "note     " + note + "\n";
    for (const std::string& note : notes_on(scene)) text += "note     " + note + "\n";
    return text;
}

struct InfoOptions {
    SceneOptions scene;  ///< or a photon map
    std::string map_scene;
    bool is_quick = false;  ///< nothing is rendered
    bool beams = false;
    std::vector<std::string> params;  ///< of `beamtree`, for its beams
    std::string output;
    std::optional<double> dot;  ///< pixels
};

/// Draws a picture with the whole machine, showing its progress, and writes it.
void write_drawing(const Scene& scene, const std::string& output,
                   const std::function<Picture(const RunOptions&)>& draw) {
    RunOptions run;
    run.threads = available_threads();
    run.samples_per_pixel = scene.sampling().sample_count;
    run.adaptive = false;
    const RunProgress progress(run);
    write_png(draw(run), output);
}

void require_no_picture(const std::filesystem::path& file) {
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(file, unknown)) return;
    std::string start(8, '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(start.data(), static_cast<std::streamsize>(start.size()));
    if (is_exr(start) || is_png(start))
        throw InputError(
            fmt::format("{}: is a picture; info tells of scenes (JSON) and of photon maps (compare "
                        "judges pictures)",
                        file.string()));
}

void info_on_scene(const InfoOptions& options) {
    if (!options.map_scene.empty())
        throw InputError(
            fmt::format("{} is no photon map: --scene is for these", options.scene.file));
    if (options.beams == options.output.empty() || (!options.beams && !options.params.empty()))
        throw InputError("--beams and -o belong together, for a scene; --param is for them");
    if (options.dot) throw InputError("--dot is for photons, which -o draws of a photon map");
    if (options.beams) require_png("-o", options.output, "beams");
    SceneFile file = options.scene.load(options.is_quick && !options.beams ? PictureDepth::header
                                                                           : PictureDepth::whole);
    const Scene scene(std::move(file.desc));  // a copy of large meshes takes seconds
    if (options.beams) {
        require_files_apart({options.output}, {}, file.files);
        write_drawing(scene, options.output, [&](const RunOptions& run) {
            return draw_beams(scene, parameters_node(options.params), run);
        });
    }
    write_stdout(describe_scene(options.scene, file, scene, options.is_quick));
}

void draw(const InfoOptions& options, photonmap::SavedPhotons saved) {
    SceneFile file = load_scene(options.map_scene, options.scene.overrides());
    const Scene scene(std::move(file.desc));
    photonmap::require_transport(saved.origin, scene, options.scene.file);
    if (options.output.empty()) return;
    file.files.emplace_back(options.scene.file);
    require_files_apart({options.output}, {}, file.files);
    write_drawing(scene, options.output, [&](const RunOptions& run) {
        return draw_photons(scene, std::move(saved.photons), options.dot.value_or(1), run);
    });
}

void info_on_map(const InfoOptions& options) {
    if (options.map_scene.empty() && !(options.output.empty() && options.scene.sets.empty()))
        throw InputError("-o and --set need --scene: the scene that the photons are drawn in");
    if (options.beams || options.is_quick || !options.params.empty())
        throw InputError("--beams, --param and --quick are for scenes");
    if (options.dot && options.output.empty())
        throw InputError("--dot is for photons that are drawn, by -o");
    if (!options.output.empty()) require_png("-o", options.output, "photons");
    photonmap::SavedPhotons saved = photonmap::load_photon_map(options.scene.file);
    const std::string text = describe_map(options.scene.file, saved);
    if (!options.map_scene.empty()) draw(options, std::move(saved));
    write_stdout(text);
}

}  // namespace

Verb add_info(CLI::App& app) {
    auto options = std::make_shared<InfoOptions>();
    CLI::App* const verb = app.add_subcommand(
        "info", "What a scene holds and which methods can serve it, or what a photon map holds");
    options->scene.add_to(*verb);
    verb->get_option("SCENE")->description("Scene file (JSON), or a photon map's file");
    verb->add_option("--scene", options->map_scene,
                     "Of a photon map: the scene that it must belong to, and is drawn in")
        ->type_name("SCENE");
    verb->add_option(
            "-o,--output", options->output,
            "Picture (.png) of a photon map's photons as dots, through the scene's camera; "
            "as bright as the logarithm of their number, over the dim scene; or of a scene's beams")
        ->type_name("FILE");
    verb->add_flag(
        "--quick", options->is_quick,
        "Leave out what pictures take, which is foretold by small trials of each method");
    verb->add_flag("--beams", options->beams,
                   "Draw the caustic polygons of `beamtree` over its picture: orange, blue where "
                   "they are turned over, white between the two, where the caustic is");
    add_repeatable(*verb, "--param", options->params,
                   "With --beams: parameter of `beamtree`, key=value. Repeatable");
    add_number(*verb, "--dot", options->dot, 0.1, 100.0,
               "Radius of the dots in pixels (default 1)");
    verb->footer(
        "Example:\n  causticbench info pool.json --set /water/resolution=64\n"
        "  causticbench info pool.json --beams --set /water/resolution=32 -o beams.png\n"
        "  causticbench info pool.photons --scene pool.json -o photons.png");
    return {verb, [options] {
                end_soon_after_interrupts();
                require_no_picture(options->scene.file);
                if (photonmap::is_photon_map(options->scene.file))
                    info_on_map(*options);
                else
                    info_on_scene(*options);
                return 0;
            }};
}

}  // namespace caustics::experiments
