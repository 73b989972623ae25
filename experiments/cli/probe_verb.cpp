#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <memory>

#include "core/base/error.h"
#include "experiments/base/file_io.h"
#include "experiments/base/signals.h"
#include "experiments/cli/verbs.h"
#include "experiments/run/cli_options.h"
#include "experiments/run/probe.h"
#include "experiments/run/render_and_score.h"
#include "experiments/run/run_progress.h"
#include "experiments/run/written_files.h"

namespace caustics::experiments {

namespace {

struct ProbeOptions {
    SceneOptions scene;
    MethodOptions method;
    IndirectOptions indirect;
    std::string layer = "caustic";
    RunFlags run;
    std::string points;
    std::string output = "-";
};

/// The request that the command line makes, but for the method of a layer that is not asked for.
RunRequest request_of_probe(const ProbeOptions& options) {
    RunRequest request{options.scene.file, options.scene.overrides(), {}, options.run.seed, 1};
    if (options.layer == "indirect") {
        if (!options.method.name.empty() || !options.method.params.empty())
            throw InputError(
                "--method, --param: probe answers one layer; leave them out with --layer indirect");
        request.indirect = options.indirect.parse();
        const std::vector<std::string>& all = indirect_names();
        if (!request.indirect)  // "none" comes first
            throw InputError(
                fmt::format("--layer indirect: name its method by --indirect (known: {})",
                            fmt::join(all.begin() + 1, all.end(), ", ")));
    } else {
        if (options.method.name.empty())
            throw InputError("--method is required (or --layer indirect with --indirect METHOD)");
        if (options.indirect.parse())
            throw InputError("--indirect: probe answers one layer; give --layer indirect as well");
        request.method = options.method.parse();
    }
    return request;
}

ProbeAnswers probe_shown(const Scene& scene, const RunRequest& request, const ProbeList& list,
                         RunOptions options) {
    const RunProgress progress(options);
    return request.indirect ? probe(scene, *request.indirect, list, options)
                            : probe(scene, request.method, list, options);
}

int probe_points(const ProbeOptions& options) {
    end_soon_after_interrupts();
    const bool to_file = options.output != "-";
    if (to_file) require_writable_place(options.output);
    SceneFile file = options.scene.load();
    const RunRequest request = request_of_probe(options);
    std::vector<std::filesystem::path> read = file.files;
    if (options.points != "-") read.emplace_back(options.points);
    require_files_apart(to_file ? std::vector{options.output} : std::vector<std::string>(), request,
                        read);
    const ProbeList list = read_probe_list(options.points);
    const Scene scene(std::move(file.desc));  // a copy of large meshes takes seconds
    RunOptions run = options.run.options(1);
    run.origin = command("probe", request);
    const ProbeAnswers answers = probe_shown(scene, request, list, run);
    print_notes(answers.notes);
    const std::string table = probe_table(list, answers);
    if (to_file)
        write_atomic_file(options.output, table);
    else
        write_stdout(table);
    return 0;
}

}  // namespace

Verb add_probe(CLI::App& app) {
    auto options = std::make_shared<ProbeOptions>();
    CLI::App* const verb =
        app.add_subcommand("probe", "Caustic irradiance and radiance at a list of points");
    options->scene.add_to(*verb);
    options->method.add_to(*verb, false);
    options->indirect.add_to(*verb);
    verb->add_option("--layer", options->layer,
                     "Light that is asked for: caustic, by --method, or indirect, by --indirect "
                     "(default: caustic)")
        ->check(CLI::IsMember({"caustic", "indirect"}))
        ->type_name("NAME");
    options->run.add_to(*verb);
    verb->add_option("--points", options->points,
                     "CSV with columns x,y,z,nx,ny,nz and optionally wx,wy,wz (towards the viewer) "
                     "and radius [m]; - reads standard input")
        ->required()
        ->type_name("FILE");
    verb->add_option("-o,--output", options->output, "CSV to write (default: -, standard output)")
        ->type_name("FILE");
    verb->footer(
        "Writes the rows as they are plus irradiance_r,g,b [W/m^2] on the side of the normal, with "
        "a viewer\nradiance_r,g,b [W/(m^2 sr)], and for statistical methods stderr_*: where no "
        "light path came, the error of\none path, three of which bound the value in 95 % of cases. "
        "The side of a "
        "one-sided material that scatters no light reads 0.\n"
        "Example:\n  causticbench probe pool.json --method lighttrace --param paths=1000000 "
        "--param radius=0.01 --points floor.csv -o out.csv");
    return {verb, [options] { return probe_points(*options); }};
}

}  // namespace caustics::experiments
