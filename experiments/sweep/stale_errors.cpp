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

bool are_of_one_picture(double mean, double other) {
    constexpr double rounding = 1e-9;
    return std::abs(mean - other) <= rounding * std::abs(other);
}

StaleErrors stale_errors(const SweepPlan& plan, const SweepStatus& status,
                         ReferenceCache& references) {
    std::map<std::string, std::vector<const Trial*>> judged;
    for (const Trial& trial : plan.trials)
        if (trial.reference && status.judged_by.contains(trial.id))
            judged[trial.reference->key].push_back(&trial);
    StaleErrors stale;
    for (const auto& [key, trials] : judged) {
        const ReferenceRequest& request = *trials[0]->reference;
        if (references.must_render(request)) continue;
        try {
            const double now = references.get(request)->caustic.mean;
            for (const Trial* trial : trials)
                if (!are_of_one_picture(status.judged_by.at(trial->id), now))
                    stale.trials.push_back(trial);
        } catch (const InputError& error) {
            stale.unreadable.push_back(error.what());
        }
    }
    return stale;
}

ErrorsAnew take_errors_anew(const Trial& trial, const TrialStore& store,
                            const Reference& reference) {
    if (!std::filesystem::exists(store.image_of(trial.id))) return ErrorsAnew::picture_is_gone;
    std::optional<nlohmann::json> record = store.record(trial.id);
    if (!record) return ErrorsAnew::picture_is_gone;
    const bool had_flip = record->contains("flip");
    record_errors(*record, read_exr(store.image_of(trial.id)), reference);
    const std::filesystem::path folder = store.begin(trial.id);
    for (const char* name : {"image.exr", "log.txt"}) {
        const std::filesystem::path file = store.folder_of(trial.id) / name;
        if (!std::filesystem::exists(file)) continue;
        write_atomic_file(folder / name, read_whole_file(file));
    }
    store.commit(trial.id, *record);
    return had_flip ? ErrorsAnew::taken_but_flip : ErrorsAnew::taken;
}

}  // namespace caustics::experiments
