#include <fmt/format.h>

#include <memory>

#include "core/base/error.h"
#include "experiments/base/child_process.h"
#include "experiments/base/environment.h"
#include "experiments/base/file_io.h"
#include "experiments/base/number_option.h"
#include "experiments/cli/verbs.h"
#include "experiments/run/cli_options.h"
#include "experiments/sweep/dry_run.h"
#include "experiments/sweep/sweep.h"

namespace caustics::experiments {

namespace {

struct SweepFlags {
    std::vector<std::string> files;
    std::string folder;
    std::string references = "keep";
    MachineFlags machine;
    bool force = false;
    bool fail_fast = false;
    bool list = false;
    bool dry_run = false;
    std::string rerun;
    std::string shard;
    std::vector<std::string> filters;
    double timeout = 0;
    double memory = 0;  ///< MiB
    int jobs = 1;
};

SweepOptions options_of(const SweepFlags& flags) {
    if (flags.memory > 0 && resident_bytes() == 0)
        throw InputError("--memory: cannot be held without /proc, which shows what a trial uses");
    SweepOptions options;
    options.folder = flags.folder;
    if (!flags.shard.empty()) options.shard = parse_shard(flags.shard);
    options.force = flags.force;
    options.rerun_failed = !flags.rerun.empty();
    options.fail_fast = flags.fail_fast;
    if (flags.references == "rebuild") options.references = ReferencePolicy::rebuild;
    if (flags.references == "extend") options.references = ReferencePolicy::extend;
    options.only_references = flags.references == "only";
    options.trials.jobs = flags.jobs;
    options.trials.threads = flags.machine.threads;
    options.trials.isa = flags.machine.isa;
    options.trials.timeout = flags.timeout;
    options.trials.memory_bytes = static_cast<std::uint64_t>(flags.memory * 1048576);
    return options;
}

int sweep(const SweepFlags& flags) {
    const SweepOptions options = options_of(flags);
    SweepPlan plan = read_plan({flags.files.begin(), flags.files.end()}, [](const auto& work) {
        return run_in_child([&](const ChildProcess::Tell&) { return work(); });
    });
    choose(plan, flags.filters);
    if (flags.list || flags.dry_run) {
        write_stdout(flags.list ? list_plan(plan, options) : dry_run(plan, options));
        return 0;
    }
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
    CLI::Option* const list =
        verb->add_flag("--list", flags->list, "Only list the trials and whether they are done");
    verb->add_flag("--dry-run", flags->dry_run,
                   "Only tell how many trials are to run, how long it will take, and disk")
        ->excludes(list);
    add_repeatable(*verb, "--filter", flags->filters,
                   "Only trials with key=value: trial, scene, method, seed, repeat or a swept key. "
                   "Repeatable: the same key means or, different keys mean and")
        ->type_name("KEY=VALUE");
    verb->add_option("--shard", flags->shard,
                     "Only part i of n of the trials, from 1; auto: the task of a Slurm job array")
        ->type_name("I/N");
    CLI::Option* const force =
        verb->add_flag("--force", flags->force, "Run trials again that are done");
    verb->add_option("--rerun", flags->rerun, "failed: run trials again that failed or timed out")
        ->check(CLI::IsMember({"failed"}))
        ->excludes(force);
    verb->add_flag("--fail-fast", flags->fail_fast, "Stop at the first trial that fails");
    add_number(*verb, "--timeout", flags->timeout, 0.001, 1e9,
               "Seconds after which a trial is given up");
    add_number(*verb, "--memory", flags->memory, 1.0, 1073741824.0,
               "MiB that a trial may have in memory at a time");
    add_number(*verb, "--jobs", flags->jobs, 1, 4096,
               "Trials at a time (default 1, so that times hold)");
    verb->add_option("--references", flags->references,
                     "keep: use the references that are there; rebuild: render them anew; extend: "
                     "begin those missing with the samples of smaller ones that are there; only: "
                     "render those missing and run no trial")
        ->check(CLI::IsMember({"keep", "rebuild", "extend", "only"}));
    flags->machine.add_to(*verb, "as the sweep file says, or 1");
    verb->footer(
        "Each trial runs in a process of its own; what it leaves behind is whole or absent. Trials "
        "with a record are\nskipped, so that the same command goes on where it was stopped. Writes "
        "DIR/records.csv and .jsonl (one row a\ntrial; results/records.md lists the columns), "
        "DIR/trials/ID/{record.json,image.exr,log.txt},\nDIR/report/figures/ID.png (reference | "
        "picture | signed error), DIR/plan.json, DIR/environment.json.\n"
        "Example:\n  causticbench sweep experiments/sweeps/tiny.json -o out --timeout 600 --memory "
        "4000");
    return {verb, [flags] { return sweep(*flags); }};
}

}  // namespace caustics::experiments
