#include "experiments/sweep/trial_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/error.h"
#include "experiments/base/environment.h"
#include "experiments/base/file_io.h"
#include "experiments/plan/trial.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* log_name = "log.txt";

/// What happens in the child.
std::string work(const Trial& trial, ReferenceCache& references, const RunOptions& options,
                 const fs::path& folder) {
    const auto log = [](const std::string& line) { write_stderr(line + "\n"); };
    const TrialOutcome outcome = run_trial(trial, references, options, log);
    if (outcome.film) write_exr(*outcome.film, folder / "image.exr");
    // Messages may hold names of files in any encoding.
    return outcome.record.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

TrialRunner::TrialRunner(const TrialStore& store, ReferenceCache& references,
                         const TrialSettings& settings, std::function<void()> before_storing)
    : store_(store),
      references_(references),
      settings_(settings),
      before_storing_(std::move(before_storing)),
      processors_(own_processors()) {}

TrialRunner::~TrialRunner() {
    while (!slots_.empty()) {
        const Trial* const trial = slots_.back().trial;
        slots_.pop_back();  // kills it
        store_.drop(trial->id);
    }
}

bool TrialRunner::has_room() const {
    return slots_.size() < static_cast<std::size_t>(settings_.jobs);
}

void TrialRunner::start(const Trial& trial) {
    RunOptions options;
    options.threads = settings_.threads_of(trial);
    options.isa = settings_.isa;
    int place = 0;
    while (std::ranges::any_of(slots_, [&](const Slot& slot) { return slot.place == place; }))
        ++place;
    ChildLimits limits{settings_.timeout, settings_.memory_bytes, {}};
    const auto threads = static_cast<std::size_t>(options.threads);
    const std::size_t first = static_cast<std::size_t>(place) * threads;
    if (settings_.jobs > 1 && first + threads <= processors_.size())
        limits.processors.assign(
            processors_.begin() + static_cast<std::ptrdiff_t>(first),
            processors_.begin() + static_cast<std::ptrdiff_t>(first + threads));
    const fs::path folder = store_.begin(trial.id);
    const auto in_child = [&, folder](const ChildProcess::Tell& tell) {
        options.progress = tell;
        return work(trial, references_, options, folder);
    };
    slots_.push_back({&trial, place, ChildProcess(in_child, limits, folder / log_name)});
}

json TrialRunner::unfinished_record(const Trial& trial) const {
    RunOptions options;
    options.threads = settings_.threads_of(trial);
    options.isa = settings_.isa;
    return trial_record(trial, "interrupted", options);
}

void TrialRunner::store(const Trial& trial, json& record, double seconds) const {
    record["elapsed_s"] = seconds;
    record["finished"] = utc_now();
    record["limits"]["jobs"] = settings_.jobs;
    if (settings_.timeout > 0) record["limits"]["timeout_s"] = settings_.timeout;
    if (settings_.memory_bytes > 0) record["limits"]["memory_bytes"] = settings_.memory_bytes;
    before_storing_();
    store_.commit(trial.id, record);
}

json TrialRunner::refuse(const Trial& trial, const std::string& message) const {
    json record = unfinished_record(trial);
    record["status"] = "failed";
    record["message"] = message;
    const fs::path folder = store_.begin(trial.id);
    std::ofstream(folder / log_name) << "failed: " << message << '\n';
    store(trial, record, 0);
    return record;
}

json TrialRunner::finish(const Trial& trial, const ChildProcess& child) const {
    const ChildEnd& end = child.end();
    if (end.how == ChildEnd::How::answered) return json::parse(end.text);
    // The trial itself turns everything into a record: this is a file that could not be written.
    if (end.how == ChildEnd::How::bad_input) throw InputError(end.text);
    json record = unfinished_record(trial);
    record["status"] = end.how == ChildEnd::How::timed_out ? "timeout" : "failed";
    record["message"] = end.text;
    const fs::path folder = store_.temporary_of(trial.id);
    std::error_code none;
    fs::remove(folder / "image.exr", none);
    std::ofstream(folder / log_name, std::ios::app)
        << fmt::format("{}: {}\n", record["status"].get<std::string>(), end.text);
    return record;
}

std::vector<TrialRunner::Finished> TrialRunner::wait() {
    std::vector<ChildProcess*> children;
    for (Slot& slot : slots_) children.push_back(&slot.child);
    wait_for_any(children);
    std::vector<Finished> finished;
    for (auto slot = slots_.begin(); slot != slots_.end();) {
        if (!slot->child.has_ended()) {
            ++slot;
            continue;
        }
        json record = finish(*slot->trial, slot->child);
        if (record.at("status") == "left")
            store_.drop(slot->trial->id);
        else
            store(*slot->trial, record, slot->child.seconds());
        finished.push_back({slot->trial, std::move(record)});
        slot = slots_.erase(slot);
    }
    return finished;
}

std::vector<TrialRunner::Running> TrialRunner::running() const {
    std::vector<Running> all;
    for (const Slot& slot : slots_)
        all.push_back({slot.trial, slot.child.seconds(), slot.child.share()});
    return all;
}

}  // namespace caustics::experiments
