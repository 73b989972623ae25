#include <nlohmann/json.hpp>

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
// as JSON. It names its own bytes where they are no JSON: "plan.json".

namespace {

using namespace caustics;
using namespace caustics::experiments;
using nlohmann::json;

constexpr const char* files[] = {"plan.json",           ".table",        "environment.json",
                                 "records.csv",         "records.jsonl", "trials/a/record.json",
                                 "trials/b/record.json"};

void put_folder(std::string_view text) {
    std::filesystem::remove_all(fuzz::scratch() / "out");
    std::filesystem::remove_all(fuzz::scratch() / "merged");
    const auto bounded = [](int depth, json::parse_event_t, json&) { return depth < 100; };
    const json all = json::parse(text, bounded, false);
    if (!all.is_object()) {
        fuzz::put("out/plan.json", text);
        return;
    }
    for (const char* file : files) {
        if (!all.contains(file)) continue;
        const json& content = all.at(file);
        fuzz::put(std::filesystem::path("out") / file,
                  content.is_string()
                      ? content.get<std::string>()
                      : content.dump(-1, ' ', false, json::error_handler_t::replace));
    }
}

void read_folder() {
    const auto folder = fuzz::scratch() / "out";
    const TrialStore store(folder);
    for (const char* trial : {"a", "b"})
        fuzz::taken(fuzz::Naming::file, [&] { store.record(trial); });
    fuzz::taken(fuzz::Naming::file, [&] { merge_results({folder}, fuzz::scratch() / "merged"); });
    fuzz::taken(fuzz::Naming::file, [&] { explain(folder, "a"); });
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
        std::vector<std::string> known = {"a",          "b",       "../c",        "done",
                                          "failed",     "timeout", "unsupported", "running",
                                          "none",       "plain",   "avx2",        "version",
                                          "trials",     "trial",   "cell",        "seed",
                                          "chosen",     "swept",   "sweeps",      "filters",
                                          "started_in", "rows",    "variances",   "complete",
                                          "csv",        "jsonl",   "parameters",  "set",
                                          "file",       "name",    "hash",        "code_version",
                                          "photonmap",  "\n$(x)`", "=1+1"};
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
    put_folder(fuzz::view(data, size));
    read_folder();
    return 0;
}
