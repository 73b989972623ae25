#include "experiments/sweep/stale_errors.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/base/file_io.h"
#include "experiments/plan/trial.h"

namespace caustics::experiments {

namespace {

/// Of the means of one picture.
constexpr double rounding = 1e-9;

/// The mean of a reference's caustics; nothing where there is no such picture now.
std::optional<double> mean_of(const ReferenceRequest& request, ReferenceCache& references) {
    if (references.must_render(request)) return {};
    try {
        return references.get(request)->caustic.mean;
    } catch (const InputError&) {
        return {};  // who asks for it hears why
    }
}

}  // namespace

std::vector<const Trial*> trials_with_stale_errors(const SweepPlan& plan, const SweepStatus& status,
                                                   ReferenceCache& references) {
    std::map<std::string, std::vector<const Trial*>> judged;
    for (const Trial& trial : plan.trials)
        if (trial.reference && status.judged_by.contains(trial.id))
            judged[trial.reference->key].push_back(&trial);
    std::vector<const Trial*> stale;
    for (const auto& [key, trials] : judged) {
        const std::optional<double> now = mean_of(*trials[0]->reference, references);
        if (!now) continue;
        for (const Trial* trial : trials)
            if (std::abs(status.judged_by.at(trial->id) - *now) > rounding * std::abs(*now))
                stale.push_back(trial);
    }
    return stale;
}

bool take_errors_anew(const Trial& trial, const TrialStore& store, const Reference& reference) {
    if (!std::filesystem::exists(store.image_of(trial.id))) return false;
    std::optional<nlohmann::json> record = store.record(trial.id);
    if (!record) return false;
    record_errors(*record, read_exr(store.image_of(trial.id)), reference);
    const std::filesystem::path folder = store.begin(trial.id);
    for (const char* name : {"image.exr", "log.txt"}) {
        const std::filesystem::path file = store.folder_of(trial.id) / name;
        if (!std::filesystem::exists(file)) continue;
        std::error_code error;
        std::filesystem::copy_file(file, folder / name, error);
        if (error)
            throw InputError((folder / name).string() + ": cannot be written (" + error.message() +
                             ")");
    }
    store.commit(trial.id, *record);
    return true;
}

}  // namespace caustics::experiments
