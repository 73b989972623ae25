#include <nlohmann/json.hpp>

#include "core/base/hash.h"
#include "experiments/base/environment.h"
#include "experiments/cli/explain.h"
#include "experiments/plan/plan_file.h"
#include "experiments/plan/record_columns.h"
#include "experiments/plan/trial_store.h"
#include "experiments/report/record_table.h"
#include "experiments/sweep/merge.h"
#include "tests/fuzz/json_hooks.h"
#include "tests/fuzz/reading.h"
#include "tests/fuzz/small_scene.h"

// The input is one JSON object whose members are the files of a sweep's folder: text as it is, any other value
// as JSON. Bytes that are no JSON are plan.json. Members "two/..." make a folder beside it, to be merged with it;
// "explain" is the trial to explain, "into" where to merge. "own" in .table is what this program would write there.

namespace {

using namespace caustics;
using namespace caustics::experiments;
using nlohmann::json;

constexpr const char* files[] = {"plan.json",
                                 ".table",
                                 "environment.json",
                                 "records.csv",
                                 "records.jsonl",
                                 "references/r.exr",
                                 "references/r.txt",
                                 "report/figures/a.png",
                                 "trials/a/record.json",
                                 "trials/b/record.json",
                                 "two/plan.json",
                                 "two/environment.json",
                                 "two/references/r.exr",
                                 "two/trials/b/record.json"};

/// What the folder is asked, by words of the input.
struct Questions {
    std::string explained = "a";
    std::string merged_into = "merged";
};

/// Nothing of an index is read whose checksums do not fit.
void own_what_says_so(json& table, const json& all) {
    if (!table.is_object()) return;
    const auto own = [&](const char* key, const std::string& value) {
        if (table.contains(key) && table.at(key) == "own") table[key] = value;
    };
    const auto hash_of = [&](const char* file) {
        return all.contains(file) && all.at(file).is_string()
                   ? hex(fnv1a(all.at(file).get<std::string>()))
                   : "";
    };
    own("code_version", code_version());
    own("csv", hash_of("records.csv"));
    own("jsonl", hash_of("records.jsonl"));
}

std::string word(const json& all, const char* key, const std::string& otherwise) {
    const auto found = all.find(key);
    return found != all.end() && found->is_string() ? found->get<std::string>() : otherwise;
}

Questions put_folder(std::string_view text) {
    for (const char* folder : {"out", "two", "merged"})
        std::filesystem::remove_all(fuzz::named(folder));
    const auto bounded = [](int depth, json::parse_event_t, json&) { return depth < 100; };
    json all = json::parse(text, bounded, false);
    if (!all.is_object()) {
        fuzz::put("out/plan.json", text);
        return {};
    }
    if (all.contains(".table")) own_what_says_so(all.at(".table"), all);
    for (const std::string file : files) {
        if (!all.contains(file)) continue;
        const json& content = all.at(file);
        fuzz::put(file.starts_with("two/") ? file : "out/" + file,
                  content.is_string()
                      ? content.get<std::string>()
                      : content.dump(-1, ' ', false, json::error_handler_t::replace));
    }
    const std::string into = word(all, "into", "merged");
    return {word(all, "explain", "a"), into == "two" || into == "out/merged" ? into : "merged"};
}

void read_folder(const Questions& asked) {
    const auto folder = fuzz::named("out");
    std::vector<std::filesystem::path> folders = {folder};
    if (std::filesystem::exists(fuzz::named("two"))) folders.push_back(fuzz::named("two"));
    const TrialStore store(folder);
    for (const char* trial : {"a", "b"})
        fuzz::taken(fuzz::Naming::file, [&] { store.record(trial); });
    fuzz::taken(fuzz::Naming::file,
                [&] { merge_results(folders, fuzz::named(asked.merged_into)); });
    fuzz::taken(fuzz::Naming::file, [&] { explain(folder, asked.explained); });
    fuzz::taken(fuzz::Naming::file, [&] {
        const PlanFile plan = read_plan_of(folder);
        write_records(folder, store, plan, {}, [](const TableRow&) {});
        // From its own index.
        write_records(folder, store, plan, {}, [](const TableRow&) {});
    });
}

}  // namespace

const std::vector<std::string>& caustics::fuzz::words() {
    static const std::vector<std::string> all = [] {
        std::vector<std::string> known = {"a",
                                          "b",
                                          "../c",
                                          "done",
                                          "failed",
                                          "timeout",
                                          "unsupported",
                                          "running",
                                          "none",
                                          "plain",
                                          "avx2",
                                          "version",
                                          "trials",
                                          "trial",
                                          "cell",
                                          "seed",
                                          "chosen",
                                          "swept",
                                          "sweeps",
                                          "filters",
                                          "started_in",
                                          "rows",
                                          "variances",
                                          "complete",
                                          "csv",
                                          "jsonl",
                                          "parameters",
                                          "set",
                                          "file",
                                          "name",
                                          "hash",
                                          "code_version",
                                          "photonmap",
                                          "\n$(x)`",
                                          "=1+1",
                                          "explain",
                                          "reference_mean",
                                          "small.json",
                                          "lighttrace",
                                          "spp",
                                          "files",
                                          "indirect",
                                          "reference"};
        for (const RecordColumn& column : record_columns_of_all()) {
            known.emplace_back(column.name);
            known.emplace_back(column.pointer);
        }
        for (const char* file : files) known.emplace_back(file);
        return known;
    }();
    return all;
}

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    fuzz::put("small.json", fuzz::small_scene);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    read_folder(put_folder(fuzz::view(data, size)));
    return 0;
}
