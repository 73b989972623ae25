#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "experiments/base/atomic_folder.h"
#include "experiments/base/file_io.h"
#include "experiments/base/number_option.h"
#include "experiments/base/signals.h"
#include "experiments/cli/verbs.h"
#include "experiments/export/exported_scene.h"
#include "experiments/run/cli_options.h"

namespace caustics::experiments {

namespace {

struct ExportOptions {
    SceneOptions scene;
    std::string target;
    std::string folder;
    ExportSettings settings;
    int wavelengths = 0;
};

ExportedScene exported_scene(const SceneDesc& scene, const ExportOptions& options) {
    if (options.target == "povray") {
        if (options.wavelengths > 0)
            throw InputError("--wavelengths: POV-Ray disperses light by itself; leave it out");
        return to_povray(scene, options.settings);
    }
    if (options.wavelengths > 0)
        return to_mitsuba_by_wavelength(scene, options.settings, options.wavelengths);
    return to_mitsuba(scene, options.settings);
}

int export_scene(ExportOptions options) {
    end_soon_after_interrupts();
    const SceneFile file = options.scene.load();
    options.settings.scene_file = options.scene.file;
    ExportedScene exported = exported_scene(file.desc, options);
    if (const Vec3d& o = file.desc.origin; !o.isZero(0))
        exported.notes.push_back(
            fmt::format("coordinates are relative to ({:.9g}, {:.9g}, {:.9g}) m of the scene file, "
                        "where floats resolve the scene",
                        o.x(), o.y(), o.z()));
    const std::filesystem::path folder = options.folder;
    if (std::filesystem::exists(folder) && !std::filesystem::is_directory(folder))
        throw InputError(
            fmt::format("-o {}: is no folder (a file of that name is there)", options.folder));
    end_in_own_time();  // the folder is taken away again
    AtomicFolder whole(folder);
    for (const ExportedScene::File& each : exported.files) {
        throw_if_interrupted();
        write_atomic_file(whole.path() / each.name, each.bytes);
    }
    throw_if_interrupted();
    whole.commit();
    print_notes(exported.notes);
    write_stderr(fmt::format("{}: {} file{}\n", (folder / exported.files.front().name).string(),
                             exported.files.size(), exported.files.size() == 1 ? "" : "s"));
    return 0;
}

}  // namespace

Verb add_export(CLI::App& app) {
    auto options = std::make_shared<ExportOptions>();
    CLI::App* const verb =
        app.add_subcommand("export", "Write a scene as Mitsuba 3 or POV-Ray 3.7 read it");
    options->scene.add_to(*verb);
    verb->add_option("--to", options->target, "The other renderer: mitsuba, povray")
        ->required()
        ->check(CLI::IsMember({"mitsuba", "povray"}))
        ->type_name("NAME");
    verb->add_option("-o,--output", options->folder,
                     "Folder to write to, made where it is missing: scene.xml, or scene.pov and "
                     "scene.ini, and the meshes and textures they name")
        ->required()
        ->type_name("DIR");
    add_number(*verb, "--max-bounces", options->settings.max_bounces, 1, most_bounces,
               "Specular events between light and receiver (default 1000)");
    verb->add_flag("--indirect", options->settings.indirect,
                   "With the light between receivers, as `render --indirect` has it");
    add_number(*verb, "--mesh-resolution", options->settings.mesh_resolution, 1, 4096,
               "Of exact shapes that the other renderer does not know (default 256)");
    add_number(
        *verb, "--wavelengths", options->wavelengths, 1, 4096,
        "Of a scene with dispersion: so many scenes for Mitsuba, scene_NNN.NNNnm.xml, each in the "
        "light of one; add up their pictures");
    verb->footer(
        "Units stay: watts, pixels in W/(m^2 sr), and metres, of which POV-Ray gets many or few "
        "units (its tolerances are lengths). A scene that the other renderer "
        "cannot express is refused (exit code 3).\n"
        "Without --indirect, Mitsuba still follows some light from one diffuse surface to another: "
        "compare over dark receivers. POV-Ray does not scale radiance by n^2 where the eye looks "
        "into a medium.\n"
        "Example:\n  causticbench export ring.json --to mitsuba -o ring "
        "--set '/floor/bsdf={\"type\":\"diffuse\",\"reflectance\":0.01}'\n"
        "  mitsuba -m scalar_rgb -D spp=4096 ring/scene.xml");
    return {verb, [options] { return export_scene(*options); }};
}

}  // namespace caustics::experiments
