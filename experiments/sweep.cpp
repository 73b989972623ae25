#include "experiments/sweep.h"

#include <fmt/format.h>

#include <cstdio>

#include "core/error.h"
#include "core/parallel.h"
#include "experiments/environment.h"
#include "experiments/files.h"
#include "experiments/interrupt.h"
#include "experiments/job_store.h"
#include "experiments/progress.h"
#include "experiments/reference_cache.h"
#include "experiments/stopwatch.h"
#include "experiments/sweep_outputs.h"

namespace caustics {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

std::string status(const json& record) { return record.at("status").get<std::string>(); }

std::string result_line(const json& record) {
    const json::json_pointer rmse("/metrics/rmse");
    if (record.contains("message"))
        return status(record) + ": " + record.at("message").get<std::string>();
    if (record.contains(rmse) && record.at(rmse).is_number())
        return fmt::format("rmse {:.4g}", record.at(rmse).get<double>());
    return status(record);
}

class Sweep {
public:
    Sweep(const SweepPlan& plan, const SweepOptions& options)
        : plan_(plan),
          options_(options),
          store_(options.folder),
          references_(options.folder / "references", options.rebuild_references) {}

    int run() {
        std::vector<const Trial*> todo;
        for (const Trial& trial : plan_.trials) {
            std::optional<json> record = store_.record(trial.id);
            if (record && status(*record) != "failed" && !options_.force)
                records_.push_back(std::move(*record));
            else
                todo.push_back(&trial);
        }
        if (!todo.empty())
            write_whole_file(options_.folder / "environment.json", environment().dump(2) + "\n");
        try {
            run_all(todo);
            remake_unused_references();
        } catch (...) {
            write_table();
            throw;
        }
        write_table();
        const fs::path figures = options_.folder / "report" / "figures";
        fs::create_directories(figures);
        write_figures(plan_, store_, records_, fresh_, references_, reference_options(nullptr),
                      figures);
        fmt::print("records    {}\nfigures    {}\n{}", table_file().string(), figures.string(),
                   summary(records_, plan_.trials.size(), fresh_.size(), watch_.total().wall));
        return failed_ == 0 ? 0 : 1;
    }

private:
    fs::path table_file() const { return options_.folder / "records.csv"; }
    void write_table() const { write_records_csv(plan_, store_, records_, table_file()); }

    /// References use every thread there is: their time is no measurement.
    static RunOptions reference_options(Progress* progress) {
        RunOptions options;
        options.threads = available_threads();
        options.adaptive = false;
        options.progress = [progress](double share) {
            throw_if_interrupted();
            if (progress != nullptr) progress->share(share);
        };
        return options;
    }

    void run_all(const std::vector<const Trial*>& todo) {
        Progress progress(std::max<std::size_t>(todo.size(), 1));
        for (const Trial* trial : todo) {
            throw_if_interrupted();
            try {
                const TrialOutcome outcome = run_one(*trial, progress);
                store_.add(trial->id, outcome);
                fresh_.insert(trial->id);
                records_.push_back(outcome.record);
            } catch (const Interrupted&) {
                records_.push_back(trial_record(*trial, "interrupted"));
                throw;
            }
            const json& record = records_.back();
            progress.end(result_line(record));
            if (status(record) != "failed") continue;
            ++failed_;
            if (options_.fail_fast) return;
        }
    }

    TrialOutcome run_one(const Trial& trial, Progress& progress) {
        std::shared_ptr<const Reference> reference;
        if (trial.reference) {
            if (references_.must_render(*trial.reference))
                progress.begin(fmt::format("reference {} {} for {}",
                                           trial.reference->request.method.name,
                                           trial.reference->key, trial.scene_name));
            try {
                reference = references_.get(*trial.reference, reference_options(&progress));
            } catch (const Interrupted&) {
                throw;
            } catch (const std::exception& error) {
                TrialOutcome outcome{trial_record(trial, "failed"), {}, {}};
                outcome.record["message"] = fmt::format("reference: {}", error.what());
                outcome.log = fmt::format("failed: reference: {}\n", error.what());
                return outcome;
            }
        }
        progress.begin(trial.id);
        RunOptions options;
        options.threads = options_.threads > 0 ? options_.threads : trial.threads;
        options.isa = options_.isa;
        options.progress = [&](double share) { progress.share(share); };
        return run_trial(trial, reference.get(), options);
    }

    /// With everything done, `--references rebuild` still remakes what the trials stand on.
    void remake_unused_references() {
        if (!options_.rebuild_references) return;
        for (const Trial& trial : plan_.trials)
            if (trial.reference && references_.must_render(*trial.reference))
                references_.get(*trial.reference, reference_options(nullptr));
    }

    const SweepPlan& plan_;
    const SweepOptions& options_;
    JobStore store_;
    ReferenceCache references_;
    Stopwatch watch_;
    std::vector<json> records_;
    std::set<std::string> fresh_;
    std::size_t failed_ = 0;
};

}  // namespace

int run_sweep(const SweepPlan& plan, const SweepOptions& options) {
    return Sweep(plan, options).run();
}

std::string list_plan(const SweepPlan& plan, const fs::path& folder) {
    std::string text;
    std::optional<JobStore> store;
    if (fs::is_directory(folder / "trials")) store.emplace(folder);
    for (const Trial& trial : plan.trials) {
        const std::optional<json> record = store ? store->record(trial.id) : std::nullopt;
        text += fmt::format("{:<12} {}\n", record ? status(*record) : "todo", trial.id);
    }
    return text;
}

}  // namespace caustics
