#include <fmt/format.h>

#include <memory>

#include "experiments/cli_options.h"
#include "experiments/files.h"
#include "experiments/sweep.h"
#include "experiments/verbs.h"

namespace caustics {

namespace {

struct SweepFlags {
    std::vector<std::string> files;
    std::string folder;
    std::string references = "keep";
    MachineFlags machine;
    bool force = false;
    bool fail_fast = false;
    bool list = false;
};

int sweep(const SweepFlags& flags) {
    const SweepPlan plan = read_plan({flags.files.begin(), flags.files.end()});
    if (flags.list) {
        write_stdout(list_plan(plan, flags.folder));
        return 0;
    }
    SweepOptions options;
    options.folder = flags.folder;
    options.force = flags.force;
    options.fail_fast = flags.fail_fast;
    options.rebuild_references = flags.references == "rebuild";
    options.threads = flags.machine.threads;
    options.isa = flags.machine.isa;
    return run_sweep(plan, options);
}

}  // namespace

Verb add_sweep(CLI::App& app) {
    auto flags = std::make_shared<SweepFlags>();
    CLI::App* const verb = app.add_subcommand(
        "sweep", "Run every combination a sweep file names, and score it against references");
    verb->add_option("SWEEP", flags->files, "Sweep files (JSON); together they make one table")
        ->required();
    verb->add_option("-o,--output", flags->folder, "Folder of the results")
        ->required()
        ->type_name("DIR");
    verb->add_flag("--list", flags->list, "Only list the trials and whether they are done");
    verb->add_flag("--force", flags->force, "Run trials again that are done");
    verb->add_flag("--fail-fast", flags->fail_fast, "Stop at the first trial that fails");
    verb->add_option("--references", flags->references,
                     "keep: use the references that are there; rebuild: render them anew")
        ->check(CLI::IsMember({"keep", "rebuild"}));
    flags->machine.add_to(*verb, "as the sweep file says, or 1");
    verb->footer(
        "Trials that are done are skipped, those that failed run again. Writes DIR/records.csv "
        "(one "
        "row a trial),\nDIR/trials/ID/{record.json,image.exr,log.txt}, DIR/report/figures/ID.png "
        "(reference | picture | signed error),\nDIR/environment.json. parse_s, precompute_s, "
        "balance_s and render_s follow each other and add up to total_s.\n"
        "Example:\n  causticbench sweep experiments/sweeps/tiny.json -o out");
    return {verb, [flags] { return sweep(*flags); }};
}

}  // namespace caustics
