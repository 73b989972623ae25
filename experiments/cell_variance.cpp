#include "experiments/cell_variance.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "experiments/child_process.h"
#include "experiments/interrupt.h"
#include "experiments/metrics.h"

namespace caustics {

namespace {

using nlohmann::json;

/// Mean over reached pixels and channels of the sample variance over the pictures.
std::optional<double> mean_variance(const std::vector<Film>& films) {
    PixelMask reached = reached_pixels(films[0], films[0]);
    double sum = 0;
    std::size_t values = 0;
    for (std::size_t i = 0; i < reached.size(); ++i) {
        if (!reached[i]) continue;
        SpectrumSum mean = SpectrumSum::Zero();
        SpectrumSum squares = SpectrumSum::Zero();
        for (const Film& film : films) mean += film.rgb("caustic", i).cast<double>();
        mean /= static_cast<double>(films.size());
        for (const Film& film : films) {
            const SpectrumSum difference = film.rgb("caustic", i).cast<double>() - mean;
            squares += difference.square();
        }
        sum += squares.sum() / static_cast<double>(films.size() - 1);
        values += 3;
    }
    if (values == 0) return {};
    return sum / static_cast<double>(values);
}

/// The pictures a variance stands on, one a seed, and how the table knows it.
struct Cell {
    std::map<std::uint64_t, std::string> trials;
    bool as_earlier = true;
    json earlier;
};

std::string text(const json& row, const char* key) {
    const auto found = row.find(key);
    return found != row.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// Looks up what the earlier table says; a line that cannot be read says nothing.
void look_up(std::map<std::string, Cell>& cells, const std::map<std::string, std::string>& cell_of,
             const DoneTrials& done, const std::filesystem::path& table) {
    std::map<std::string, std::size_t> found;
    std::ifstream in(table);
    for (std::string line; std::getline(in, line);) {
        const json row = json::parse(line, nullptr, false);
        if (!row.is_object() || text(row, "status") != "done") continue;
        const std::string id = text(row, "trial");
        const auto place = cell_of.find(id);
        if (place == cell_of.end()) continue;
        Cell& cell = cells.at(place->second);
        ++found[place->second];
        if (!done.contains(id) || text(row, "finished") != done.at(id)) cell.as_earlier = false;
        cell.earlier = row.value("variance", json());
    }
    std::map<std::string, std::size_t> expected;
    for (const auto& [id, name] : cell_of)
        if (done.contains(id)) ++expected[name];
    for (auto& [name, cell] : cells)
        if (found[name] != expected[name]) cell.as_earlier = false;
}

json variances_of(const std::map<std::string, Cell>& cells, const JobStore& store) {
    json result = json::object();
    for (const auto& [name, cell] : cells) {
        if (cell.as_earlier) continue;
        std::vector<Film> films;
        for (const auto& [seed, id] : cell.trials) films.push_back(read_exr(store.image_of(id)));
        if (const auto variance = mean_variance(films)) result[name] = *variance;
    }
    return result;
}

}  // namespace

std::map<std::string, double> cell_variances(const PlanFile& plan, const JobStore& store,
                                             const DoneTrials& done,
                                             const std::filesystem::path& earlier_table) {
    std::map<std::string, Cell> cells;
    for (const PlanFile::Entry& trial : plan.trials)
        if (done.contains(trial.id)) cells[trial.cell].trials.emplace(trial.seed, trial.id);
    std::erase_if(cells, [](const auto& cell) { return cell.second.trials.size() < 2; });
    std::map<std::string, std::string> cell_of;
    for (const PlanFile::Entry& trial : plan.trials)
        if (cells.contains(trial.cell)) cell_of[trial.id] = trial.cell;
    look_up(cells, cell_of, done, earlier_table);

    std::map<std::string, double> result;
    bool all_known = true;
    for (const auto& [name, cell] : cells) {
        all_known = all_known && cell.as_earlier;
        if (cell.as_earlier && cell.earlier.is_number()) result[name] = cell.earlier.get<double>();
    }
    // The table of a sweep that was stopped does without.
    if (all_known || interrupt_requested()) return result;
    const json fresh = json::parse(
        run_in_child([&](const ChildProcess::Tell&) { return variances_of(cells, store).dump(); }));
    for (const auto& [name, value] : fresh.items()) result[name] = value.get<double>();
    return result;
}

}  // namespace caustics
