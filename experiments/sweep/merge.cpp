#include "experiments/sweep/merge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "experiments/base/atomic_folder.h"
#include "experiments/base/bounded_json.h"
#include "experiments/base/csv.h"
#include "experiments/base/file_io.h"
#include "experiments/base/folder_lock.h"
#include "experiments/plan/plan_file.h"
#include "experiments/plan/trial_store.h"
#include "experiments/report/record_table.h"
#include "experiments/report/trial_rows.h"
#include "experiments/sweep/stale_errors.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Where each value of something was found: value -> folder or trial of its first record.
using Origins = std::map<std::string, std::string>;

/// What trials of a folder were judged by.
struct Judged {
    double mean = 0;  ///< of the reference's caustics
    fs::path folder;
};

/// Which folder has a trial, and in how many codes, instruction sets and processors they ran.
struct Survey {
    std::map<std::string, fs::path> folder_of;
    std::map<std::string, Judged> judged;  ///< by reference
    Origins code;
    Origins isa;
    Origins cpu;
    std::map<std::string, std::size_t> statuses;
};

constexpr std::size_t most_named = 5;

/// "a, b, c and 7 more"
std::string some(const std::vector<std::string>& names) {
    const std::vector<std::string> first(
        names.begin(),
        names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), most_named)));
    const std::string more =
        names.size() > most_named ? fmt::format(" and {} more", names.size() - most_named) : "";
    return fmt::format("{}{}", fmt::join(first, ", "), more);
}

std::string all(const Origins& origins) {
    std::vector<std::string> parts;
    for (const auto& [value, folder] : origins)
        parts.push_back(fmt::format("\"{}\" in {}", value, folder));
    return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<PlanFile> read_plans(const std::vector<fs::path>& folders) {
    std::vector<PlanFile> plans;
    for (const fs::path& folder : folders) {
        if (const std::string runner = runner_at_work_on(folder); !runner.empty())
            throw InputError(fmt::format("{}: a runner still works on it ({}); wait for it",
                                         folder.string(), runner));
        plans.push_back(read_plan_of(folder));
        if (plans.back().trials != plans[0].trials)
            throw InputError(
                fmt::format("{}: not the plan of {} (other sweep files, filters or "
                            "scenes): they do not belong together",
                            folder.string(), folders[0].string()));
    }
    return plans;
}

/// A reference's name stands for one picture: `--references rebuild` and `extend` make others of it.
void require_same_judge(Survey& survey, const TableRow& row, const fs::path& folder) {
    const std::optional<double> mean = row.number("reference_mean");
    if (!mean) return;
    const std::string reference = row.text("reference");
    const auto [same, is_new] = survey.judged.emplace(reference, Judged{*mean, folder});
    if (!is_new && !are_of_one_picture(same->second.mean, *mean))
        throw InputError(fmt::format(
            "trials in {} and {} were judged by different pictures of the reference {} (means {} "
            "and {}): put one of the pictures into the references/ of both folders and sweep each "
            "again, which takes their errors anew",
            same->second.folder.string(), folder.string(), reference, shortest(same->second.mean),
            shortest(*mean)));
}

void take_in(Survey& survey, const PlanFile& plan, const fs::path& folder) {
    const TrialStore store(folder);
    const TrialRows rows(folder, store);
    for (const PlanFile::Entry& trial : plan.trials) {
        const std::optional<TableRow> row = rows.row(trial.id);
        if (!row) continue;
        const auto [place, is_new] = survey.folder_of.emplace(trial.id, folder);
        if (!is_new)
            throw InputError(fmt::format("{}: is in {} and in {}", trial.id, place->second.string(),
                                         folder.string()));
        require_same_judge(survey, *row, folder);
        ++survey.statuses[row->text("status")];
        survey.code.emplace(row->text("code_version"), folder.string());
        survey.isa.emplace(row->text("isa"), folder.string());
        survey.cpu.emplace(row->text("cpu"), folder.string());
    }
}

/// A sweep's folder holds nothing but what the sweep leaves there.
void require_outside(const fs::path& target, const fs::path& folder) {
    const fs::path whole = fs::weakly_canonical(target), source = fs::weakly_canonical(folder);
    if (std::mismatch(source.begin(), source.end(), whole.begin(), whole.end()).first ==
        source.end())
        throw InputError(fmt::format("{}: lies inside {} (name a folder outside)", target.string(),
                                     folder.string()));
}

void require_whole(const Survey& survey, const PlanFile& plan, const fs::path& folder) {
    std::vector<std::string> missing;
    for (const PlanFile::Entry& trial : plan.trials)
        if (trial.chosen && !survey.folder_of.contains(trial.id)) missing.push_back(trial.id);
    if (!missing.empty())
        throw InputError(fmt::format("{}: {} of the plan's trials are in none of the folders: {}",
                                     (folder / "plan.json").string(), missing.size(),
                                     some(missing)));
    if (survey.code.size() > 1) throw InputError("records by different code: " + all(survey.code));
    if (survey.isa.size() > 1)
        throw InputError("records of different instruction sets: " + all(survey.isa));
}

/// Not by the library's function, which blames the source where the disk is full.
void copy_bytes(const fs::path& from, const fs::path& to) {
    if (fs::exists(to)) return;
    const std::string bytes = read_whole_file(from);
    errno = 0;
    std::ofstream out(to, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out)
        throw fs::filesystem_error(
            "copy", to, std::error_code(errno != 0 ? errno : EIO, std::generic_category()));
}

/// Copies a file, or a folder with all in it. A symbolic link is refused, because it would bring in
/// whatever it names.
void copy_plain(const fs::path& from, const fs::path& to) {
    throw_if_interrupted();
    const fs::file_status status = fs::symlink_status(from);
    if (fs::is_directory(status)) {
        fs::create_directories(to);
        for (const fs::directory_entry& entry : fs::directory_iterator(from))
            copy_plain(entry.path(), to / entry.path().filename());
    } else if (fs::is_regular_file(status)) {
        copy_bytes(from, to);
    } else {
        throw InputError(fmt::format("{}: {}, and only plain files and folders are merged",
                                     from.string(),
                                     fs::is_symlink(status) ? "is a symbolic link" : "is no file"));
    }
}

/// References of one name that two folders have are one picture: `--references extend` makes others of the same name.
/// Counts them.
void take_in_references(const std::vector<fs::path>& folders, Merged& merged) {
    std::map<std::string, fs::path> first;
    for (const fs::path& folder : folders) {
        if (!fs::is_directory(folder / "references")) continue;
        for (const fs::directory_entry& file : fs::directory_iterator(folder / "references")) {
            throw_if_interrupted();
            if (file.path().extension() != ".exr" || !fs::is_regular_file(file.symlink_status()))
                continue;
            const auto [same, is_new] = first.emplace(file.path().filename().string(), file.path());
            ++(is_new ? merged.references : merged.repeated_references);
            if (!is_new && read_whole_file(same->second) != read_whole_file(file.path()))
                throw InputError(fmt::format(
                    "{} and {} are different pictures: errors against them do not compare (put one "
                    "of them into both folders and sweep each again, which takes errors anew)",
                    same->second.string(), file.path().string()));
        }
    }
}

/// Files of a folder inside each of the folders, the first of each name.
void copy_files(const std::vector<fs::path>& folders, const fs::path& inside,
                const fs::path& target, const std::function<bool(const fs::path&)>& wanted) {
    for (const fs::path& folder : folders) {
        if (!fs::is_directory(folder / inside)) continue;
        fs::create_directories(target / inside);
        for (const fs::directory_entry& file : fs::directory_iterator(folder / inside))
            if (wanted(file.path()))
                copy_plain(file.path(), target / inside / file.path().filename());
    }
}

/// One figure a cell, although several shards may have drawn one.
std::set<std::string> figures_of(const PlanFile& plan, const std::vector<fs::path>& folders) {
    std::set<std::string> names;
    std::set<std::string> cells;
    for (const PlanFile::Entry& trial : plan.trials) {
        const std::string name = trial.id + ".png";
        for (const fs::path& folder : folders)
            if (fs::exists(folder / "report/figures" / name) && cells.insert(trial.cell).second)
                names.insert(name);
    }
    return names;
}

/// What the shards' machines were: "shards" beside the folders they came from.
std::string environments(const std::vector<fs::path>& folders) {
    json shards = json::array();
    for (const fs::path& folder : folders) {
        const fs::path file = folder / "environment.json";
        if (!fs::exists(file)) continue;  // a shard without trials
        json environment =
            fs::is_regular_file(file) ? parse_bounded_or_discard(read_whole_file(file)) : json();
        if (!environment.is_object())
            throw InputError(fmt::format("{}: broken (not a JSON object)", file.string()));
        environment["folder"] = folder.string();
        shards.push_back(std::move(environment));
    }
    return json{{"shards", shards}}.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

/// What the tables lack, a line each.
std::vector<std::string> write_merged(const std::vector<fs::path>& folders, const PlanFile& plan,
                                      const Survey& survey, const fs::path& target) {
    fs::create_directories(target / "trials");
    for (const auto& [id, folder] : survey.folder_of)
        copy_plain(folder / "trials" / id, target / "trials" / id);
    copy_files(folders, "references", target,
               [](const fs::path& file) { return file.extension() == ".exr"; });
    const std::set<std::string> figures = figures_of(plan, folders);
    copy_files(folders, "report/figures", target,
               [&](const fs::path& file) { return figures.contains(file.filename().string()); });
    write_plan(plan, target);
    write_atomic_file(target / "environment.json", environments(folders));
    return write_records(target, TrialStore(target), plan, {}, [](const TableRow&) {});
}

/// Throws InputError for what the file system refuses.
std::vector<std::string> write_whole(const std::vector<fs::path>& folders, const PlanFile& plan,
                                     const Survey& survey, const fs::path& target) {
    try {
        AtomicFolder whole(target);
        std::vector<std::string> lacks = write_merged(folders, plan, survey, whole.path());
        whole.commit();
        return lacks;
    } catch (const fs::filesystem_error& error) {
        throw InputError(
            fmt::format("{}: cannot be written ({})", target.string(), reason_of(error)));
    }
}

}  // namespace

Merged merge_results(const std::vector<fs::path>& folders, const fs::path& target) {
    if (fs::exists(target) && !(fs::is_directory(target) && fs::is_empty(target)))
        throw InputError(fmt::format("{}: is there already (name a new folder)", target.string()));
    for (const fs::path& folder : folders) require_outside(target, folder);
    const std::vector<PlanFile> plans = read_plans(folders);
    Survey survey;
    for (const fs::path& folder : folders) take_in(survey, plans[0], folder);
    require_whole(survey, plans[0], folders[0]);
    Merged merged;
    take_in_references(folders, merged);
    merged.statuses = survey.statuses;
    for (const fs::path& folder : folders) merged.trials[folder];
    for (const auto& [id, folder] : survey.folder_of) ++merged.trials[folder];

    merged.warnings = write_whole(folders, plans[0], survey, target);
    if (survey.cpu.size() > 1)
        merged.warnings.push_back("times from different processors do not compare: " +
                                  all(survey.cpu));
    return merged;
}

}  // namespace caustics::experiments
