#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "experiments/base/file_io.h"
#include "experiments/cli/verbs.h"
#include "experiments/run/cli_options.h"
#include "experiments/run/probe.h"
#include "experiments/run/render_and_score.h"
#include "experiments/run/run_progress.h"

namespace caustics::experiments {

namespace {

struct ProbeOptions {
    SceneOptions scene;
    MethodOptions method;
    RunFlags run;
    std::string points;
    std::string output = "-";
};

ProbeAnswers probe_shown(const Scene& scene, const Method& method, const ProbeList& list,
                         RunOptions options) {
    const RunProgress progress(options);
    return probe(scene, method, list, options);
}

int probe_points(const ProbeOptions& options) {
    const bool to_file = options.output != "-";
    if (to_file) require_writable_place(options.output);
    const SceneFile file = options.scene.load();
    const Method method = options.method.parse();
    const ProbeList list = read_probe_list(options.points);
    const Scene scene(file.desc);
    RunOptions run = options.run.options(1);
    run.origin = command("probe", {options.scene.file, options.scene.overrides(), method,
                                   options.run.seed, run.samples_per_pixel});
    const ProbeAnswers answers = probe_shown(scene, method, list, run);
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
    options->method.add_to(*verb);
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
        "a viewer\nradiance_r,g,b [W/(m^2 sr)], and for statistical methods stderr_*. The side of "
        "a one-sided material\nthat scatters no light reads 0.\n"
        "Example:\n  causticbench probe pool.json --method lighttrace --param paths=1000000 "
        "--param radius=0.01 --points floor.csv -o out.csv");
    return {verb, [options] { return probe_points(*options); }};
}

}  // namespace caustics::experiments
