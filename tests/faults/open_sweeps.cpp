// Opens folders of results as a sweep does when it goes on, and says what it finds: a line of JSON for
// each line of standard input, which names a folder.
//
// Usage: open_sweeps SWEEP.json
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "experiments/base/child_process.h"
#include "experiments/sweep/sweep_folder.h"
#include "experiments/sweep/sweep_status.h"

namespace {

using namespace caustics;
using namespace caustics::experiments;
using nlohmann::json;

/// Those that are taken as they are: {key: "", or why it cannot be used}.
json references_of(const SweepPlan& plan, ReferenceCache& references) {
    json found = json::object();
    for (const Trial& trial : plan.trials) {
        if (!trial.reference || found.contains(trial.reference->key) ||
            references.must_render(*trial.reference))
            continue;
        std::string flaw;
        try {
            references.get(*trial.reference);
        } catch (const std::exception& error) {
            flaw = error.what();
        }
        found[trial.reference->key] = flaw;
    }
    return found;
}

json opened(const SweepPlan& plan, const std::filesystem::path& name) {
    try {
        SweepOptions options;
        options.folder = name;
        const SweepFolder folder(name);
        const SweepStatus status = sweep_status(plan, options, folder.store());
        ReferenceCache references(folder.references(), ReferencePolicy::keep);
        return {{"trials", status.statuses},
                {"broken", status.broken},
                {"references", references_of(plan, references)}};
    } catch (const std::exception& error) {
        return {{"error", error.what()}};
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const SweepPlan plan = read_plan({argv[1]}, [](const auto& work) {
        return run_in_child([&](const ChildProcess::Tell&) { return work(); });
    });
    for (std::string line; std::getline(std::cin, line);)
        std::cout << opened(plan, line).dump() << std::endl;
}
