#include "experiments/sweep/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/disk.h"
#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "core/base/parallel.h"
#include "experiments/base/environment.h"
#include "experiments/base/file_io.h"
#include "experiments/base/progress.h"
#include "experiments/base/stopwatch.h"
#include "experiments/report/record_table.h"
#include "experiments/report/strips.h"
#include "experiments/report/sweep_summary.h"
#include "experiments/run/cli_options.h"
#include "experiments/sweep/stale_errors.h"
#include "experiments/sweep/sweep_folder.h"
#include "experiments/sweep/sweep_status.h"
#include "experiments/sweep/sweep_warnings.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

std::string status_of(const json& record) { return record.at("status").get<std::string>(); }

bool is_failure(const std::string& status) { return status == "failed" || status == "timeout"; }

std::string result_text(const json& record) {
    const json::json_pointer rmse("/metrics/rmse");
    if (record.contains("message"))
        return status_of(record) + ": " + record.at("message").get<std::string>();
    if (record.contains(rmse) && record.at(rmse).is_number())
        return fmt::format("rmse {:.4g}", record.at(rmse).get<double>());
    return status_of(record);
}

std::size_t trials_of_others(const SweepPlan& plan, const TrialStore& store) {
    std::set<std::string> own;
    for (const Trial& trial : plan.trials) own.insert(trial.id);
    return static_cast<std::size_t>(std::ranges::count_if(
        store.trials(), [&](const std::string& id) { return !own.contains(id); }));
}

class Sweep {
public:
    Sweep(const SweepPlan& plan, const SweepOptions& options)
        : plan_(plan),
          options_(options),
          folder_(options.folder),
          store_(folder_.store()),
          references_(folder_.references(), options.references) {
        status_ = sweep_status(plan, options, store_);
        others_ = trials_of_others(plan, store_);
        progress_.emplace(status_.share.size(), status_.share.size() - status_.todo.size());
    }

    int run() {
        warn();
        write_plan(plan_file(plan_), options_.folder);
        if (!status_.todo.empty())
            write_atomic_file(options_.folder / "environment.json", environment().dump(2) + "\n");
        try {
            render_references();
            take_stale_errors_anew();
            if (!options_.only_references) run_trials();
        } catch (const Interrupted&) {
            save_table_of_the_stopped();
            throw;
        } catch (...) {
            save_table_of_the_stopped();
            folder_.require_same();  // where it is gone, nothing could be written
            throw;
        }
        progress_.reset();
        if (options_.only_references) return failed_references_ == 0 ? 0 : 1;
        SweepSummary summary(plan_.swept);
        print_notes(write_table(&summary));
        const fs::path figures = folder_.figures();
        make_folders(figures);
        print_notes(write_strips(
            plan_, store_, [&](const Trial& trial) { return known_status(trial) == "done"; },
            references_, figures));
        write_stdout(fmt::format(
            "records    {}{}\nfigures    {} (reference | picture | signed error)\n{}",
            (options_.folder / "records.csv").string(),
            others_ == 0 ? "" : fmt::format(" (without {} trials of other sweeps)", others_),
            figures.string(), summary.text(plan_.trials.size(), ran_, watch_.total().wall)));
        const std::size_t failed = status_.count("failed") + status_.count("timeout");
        return failed + left_ + failed_references_ == 0 ? 0 : 1;
    }

private:
    std::string known_status(const Trial& trial) const {
        const auto found = status_.statuses.find(trial.id);
        return found == status_.statuses.end() ? std::string() : found->second;
    }

    void warn() {
        for (const auto& [id, what] : status_.broken) {
            progress_->note("note: " + what);
            store_.remove(id);
        }
        for (const std::string& line : sweep_warnings(plan_, options_, status_, others_))
            progress_->note(line);
    }

    /// References use every thread there is: their time is no measurement.
    void render_references() {
        const std::vector<const ReferenceRequest*> missing = status_.references(references_);
        missing_references_ = missing.size();
        for (const ReferenceRequest* request : missing) {
            folder_.require_same();
            try {
                render_reference(*request);
                references_.note_rendered(*request);
            } catch (const Interrupted&) {
                throw;
            } catch (const UnsupportedScene& error) {
                tell_failure(*request, error.what());
                unserved_references_[request->key] = error.what();
            } catch (const std::exception& error) {
                folder_.require_same();
                tell_failure(*request, error.what());
                leave_trials_of(*request);
            }
            --missing_references_;
        }
    }

    void tell_failure(const ReferenceRequest& request, const std::string& why) {
        ++failed_references_;
        progress_->note(fmt::format("failed: reference {}: {}", request.key, why));
    }

    /// A full disk, or a process that was killed, is not the trials' fault: the same command runs them.
    void leave_trials_of(const ReferenceRequest& request) {
        const std::size_t left = std::erase_if(status_.todo, [&](const Trial* trial) {
            return trial->reference && trial->reference->key == request.key;
        });
        left_ += left;
        progress_->note(left > 0 ? fmt::format("{} trials of this reference are left to do", left)
                                 : "no trial waits for it; what was there of it stays");
    }

    void take_stale_errors_anew() {
        ReferenceCache references = references_;  // trials start without what this one reads
        std::map<ErrorsAnew, std::size_t> counts;
        const StaleErrors stale = stale_errors(plan_, status_, references);
        for (const std::string& why : stale.unreadable)
            progress_->note(fmt::format("warning: {}: the errors of its trials are kept", why));
        for (const Trial* trial : stale.trials) {
            throw_if_interrupted();
            folder_.require_same();
            const ErrorsAnew came_of_it =
                take_errors_anew(*trial, store_, *references.get(*trial->reference));
            ++counts[came_of_it];
            if (came_of_it == ErrorsAnew::picture_is_gone)
                progress_->note(fmt::format(
                    "warning: {}: was judged by another picture of its reference, and its own is "
                    "not there any more (--force runs it again)",
                    trial->id));
        }
        const std::size_t without_flip = counts[ErrorsAnew::taken_but_flip];
        if (const std::size_t anew = counts[ErrorsAnew::taken] + without_flip; anew > 0)
            progress_->note(fmt::format(
                "note: {} trials were judged by other pictures of their references: their errors "
                "are taken anew",
                anew));
        if (without_flip > 0)
            progress_->note(fmt::format(
                "note: {} of them have no flip any more: tools/flip_column.py fills it again",
                without_flip));
    }

    void render_reference(const ReferenceRequest& request) {
        const std::string what =
            fmt::format("reference {} {} for {}", request.request.method.name, request.key,
                        request.request.scene_file.stem().string());
        const Stopwatch watch;
        const auto show = [&](double share) {
            progress_->show(what, share, remaining_after(watch.total().wall, share));
        };
        show(0);
        const auto render = [&](const ChildProcess::Tell& tell) {
            RunOptions options;
            options.threads = available_threads();
            options.adaptive = false;
            options.progress = tell;
            references_.render(request, options);
            return std::string();
        };
        run_in_child(render, [&](double share) {
            if (progress_->is_due()) show(share);
        });
    }

    /// What a reference still takes that has taken so many seconds, and the trials after it; what is not known yet is
    /// left out.
    std::optional<Eta> remaining_after(double seconds, double share) {
        if (!(share > 0)) return {};
        const std::optional<double> trials = remaining();
        return Eta(seconds * (1 - share) / share + trials.value_or(0),
                   !trials || missing_references_ > 1);
    }

    void run_trials() {
        TrialRunner runner(store_, references_, options_.trials, [&] { folder_.require_same(); });
        runner_ = &runner;
        next_ = 0;
        bool stop = left_ > 0 && options_.fail_fast;
        while (!runner.running().empty() || (!stop && next_ < status_.todo.size())) {
            end_if_interrupted(runner);
            folder_.require_same();
            while (!stop && next_ < status_.todo.size() && runner.has_room())
                stop = !start(*status_.todo[next_++]) && options_.fail_fast;
            for (const TrialRunner::Finished& each : runner.wait())
                if (!finish(*each.trial, each.record) && options_.fail_fast) stop = true;
            show();
        }
        end_if_interrupted(runner);
        runner_ = nullptr;
    }

    /// The trials at work are rows of the table that say so.
    void end_if_interrupted(const TrialRunner& runner) {
        if (!interrupt_requested()) return;
        for (const TrialRunner::Running& each : runner.running())
            unfinished_[each.trial->id] = runner.unfinished_record(*each.trial);
        throw Interrupted();
    }

    /// False when the trial failed at once.
    bool start(const Trial& trial) {
        const auto unserved = trial.reference ? unserved_references_.find(trial.reference->key)
                                              : unserved_references_.end();
        if (unserved == unserved_references_.end()) {
            runner_->start(trial);
            return true;
        }
        return finish(trial, runner_->refuse(trial, "reference: " + unserved->second));
    }

    /// False when it failed.
    bool finish(const Trial& trial, const json& record) {
        const std::string status = status_of(record);
        if (status == "left") {
            ++left_;
            progress_->end(fmt::format("{}: {}; it is left to do", trial.id, result_text(record)),
                           true, remaining());
            return false;
        }
        status_.statuses[trial.id] = status;
        ++ran_;
        if (status == "done") status_.costs.add(trial, {record.at("elapsed_s").get<double>(), 0});
        std::string line = fmt::format("{}: {}, {:.2f} s", trial.id, result_text(record),
                                       record.at("elapsed_s").get<double>());
        if (is_failure(status))
            line += fmt::format(" (log: {})", (store_.folder_of(trial.id) / "log.txt").string());
        progress_->end(line, status != "done", remaining());
        return !is_failure(status);
    }

    void show() {
        if (!progress_->is_due()) return;
        const std::vector<TrialRunner::Running> running = runner_->running();
        if (running.empty()) return;
        const std::string more =
            running.size() > 1 ? fmt::format(" and {} more", running.size() - 1) : "";
        progress_->show(running[0].trial->id + more, running[0].share, remaining());
    }

    /// Seconds that the trials will still take; empty before anything is known.
    std::optional<double> remaining() {
        const auto now = std::chrono::steady_clock::now();
        const double age = std::chrono::duration<double>(now - estimated_).count();
        // A long list is not added up for each of its trials.
        constexpr double oldest = 1;
        constexpr std::size_t long_list = 100;
        const bool is_long = status_.todo.size() - next_ > long_list;
        if (is_long && waiting_ && age < oldest) return std::max(0.0, *waiting_ - age);
        estimated_ = now;
        waiting_.reset();
        double sum = 0;
        for (std::size_t i = next_; i < status_.todo.size(); ++i) {
            const std::optional<Cost> cost = status_.costs.of(*status_.todo[i]);
            if (!cost) return {};
            sum += cost->seconds;
        }
        if (runner_ != nullptr)
            for (const TrialRunner::Running& each : runner_->running()) {
                const std::optional<Cost> cost = status_.costs.of(*each.trial);
                if (!cost) return {};
                sum += std::max(0.0, cost->seconds - each.seconds);
            }
        waiting_ = sum / options_.trials.jobs;
        return waiting_;
    }

    std::vector<std::string> write_table(SweepSummary* summary) const {
        folder_.require_same();
        return write_records(options_.folder, store_, plan_file(plan_), unfinished_,
                             [&](const TableRow& row) {
                                 if (summary != nullptr) summary->add(row);
                             });
    }

    /// What stopped the sweep is what the user must hear of, not that the table could not be
    /// written because of it.
    void save_table_of_the_stopped() {
        progress_.reset();
        try {
            write_table(nullptr);
        } catch (const std::exception&) {}
    }

    const SweepPlan& plan_;
    const SweepOptions& options_;
    SweepFolder folder_;
    const TrialStore& store_;
    ReferenceCache references_;
    SweepStatus status_;
    std::optional<Progress> progress_;
    TrialRunner* runner_ = nullptr;
    std::size_t next_ = 0;  ///< of status_.todo
    std::map<std::string, json> unfinished_;
    /// By key, why the reference's method does not serve the scene.
    std::map<std::string, std::string> unserved_references_;
    std::size_t failed_references_ = 0;
    std::size_t left_ = 0;  ///< trials that could not run, by no fault of theirs
    std::size_t ran_ = 0;
    std::size_t missing_references_ = 0;  ///< with the one at work
    std::size_t others_ = 0;              ///< trials in the folder that are not in the plan
    std::optional<double> waiting_;
    std::chrono::steady_clock::time_point estimated_;
    Stopwatch watch_;
};

}  // namespace

int run_sweep(const SweepPlan& plan, const SweepOptions& options) {
    return Sweep(plan, options).run();
}

}  // namespace caustics::experiments
