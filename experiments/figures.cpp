#include "experiments/figures.h"

#include <set>
#include <string>
#include <vector>

#include "experiments/child_process.h"
#include "experiments/pictures.h"

namespace caustics {

namespace {

namespace fs = std::filesystem;

bool is_newer(const fs::path& file, const fs::path& than) {
    std::error_code missing;
    const auto time = fs::last_write_time(file, missing);
    return !missing && time > fs::last_write_time(than);
}

}  // namespace

void write_figures(const SweepPlan& plan, const JobStore& store,
                   const std::function<bool(const Trial&)>& is_done, ReferenceCache& references,
                   const fs::path& folder) {
    const auto figure_of = [&](const Trial& trial) { return folder / (trial.id + ".png"); };
    std::vector<const Trial*> missing;
    std::set<std::string> cells;
    for (const Trial& trial : plan.trials) {
        if (!trial.reference || !is_done(trial) || !cells.insert(trial.cell).second) continue;
        if (!is_newer(figure_of(trial), store.image_of(trial.id))) missing.push_back(&trial);
    }
    if (missing.empty()) return;
    run_in_child([&](const ChildProcess::Tell&) {
        for (const Trial* trial : missing) {
            const auto reference = references.get(*trial->reference);
            write_png(strip(read_exr(store.image_of(trial->id)), reference->film, "caustic"),
                      figure_of(*trial));
        }
        return std::string();
    });
}

}  // namespace caustics
