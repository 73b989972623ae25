#include "experiments/report/strips.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "experiments/base/child_process.h"
#include "experiments/picture/previews.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Whether a figure is there that no later picture contradicts.
bool is_up_to_date(const fs::path& figure, const fs::path& picture) {
    std::error_code missing;
    const auto drawn = fs::last_write_time(figure, missing);
    if (missing) return false;
    const auto rendered = fs::last_write_time(picture, missing);
    return missing || drawn > rendered;
}

/// Throws InputError when the picture cannot be read, or is none of that reference's scene.
Picture figure(const fs::path& picture, const Reference& reference) {
    const Film film = read_caustic(picture);
    if (film.width() != reference.film.width() || film.height() != reference.film.height())
        throw InputError(fmt::format("{}: of another size than its reference", picture.string()));
    return strip(film, reference.film, "caustic");
}

}  // namespace

std::vector<std::string> write_strips(const SweepPlan& plan, const TrialStore& store,
                                      const std::function<bool(const Trial&)>& is_done,
                                      ReferenceCache& references, const fs::path& folder) {
    const auto figure_of = [&](const Trial& trial) { return folder / (trial.id + ".png"); };
    std::vector<const Trial*> missing;
    std::set<std::string> cells;
    for (const Trial& trial : plan.trials) {
        if (!trial.reference || !is_done(trial) || !cells.insert(trial.cell).second) continue;
        if (!is_up_to_date(figure_of(trial), store.image_of(trial.id))) missing.push_back(&trial);
    }
    if (missing.empty()) return {};
    const json reasons = json::parse(run_in_child([&](const ChildProcess::Tell&) {
        json failures = json::array();
        for (const Trial* trial : missing) {
            std::optional<Picture> drawn;
            try {
                drawn = figure(store.image_of(trial->id), *references.get(*trial->reference));
            } catch (const InputError& error) {
                failures.push_back(error.what());
                continue;
            }
            write_png(*drawn, figure_of(*trial));
        }
        return failures.dump(-1, ' ', false, json::error_handler_t::replace);
    }));
    if (reasons.empty()) return {};
    return {fmt::format("the figures of {} cell{} are not drawn: {}", reasons.size(),
                        reasons.size() == 1 ? "" : "s", reasons[0].get<std::string>())};
}

}  // namespace caustics::experiments
