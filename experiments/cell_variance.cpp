#include "experiments/cell_variance.h"

#include <algorithm>
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

/// Gathers the sample variance over pictures, one at a time (Welford 1962).
class PictureVariance {
public:
    void add(const Film& film) {
        if (count_ == 0) {
            reached_ = reached_pixels(film, film);
            mean_.assign(film.pixel_count(), SpectrumSum::Zero());
            squares_ = mean_;
        }
        ++count_;
        for (std::size_t i = 0; i < mean_.size(); ++i) {
            const SpectrumSum value = film.rgb("caustic", i).cast<double>();
            const SpectrumSum difference = value - mean_[i];
            mean_[i] += difference / static_cast<double>(count_);
            squares_[i] += difference * (value - mean_[i]);
        }
    }
    /// Mean over reached pixels and channels; empty when there are none, or fewer than two pictures.
    std::optional<double> mean() const {
        const auto pixels = std::ranges::count(reached_, true);
        if (pixels == 0 || count_ < 2) return {};
        double sum = 0;
        for (std::size_t i = 0; i < squares_.size(); ++i)
            if (reached_[i]) sum += squares_[i].sum();
        return sum / static_cast<double>(count_ - 1) / static_cast<double>(3 * pixels);
    }

private:
    std::size_t count_ = 0;
    PixelMask reached_;
    std::vector<SpectrumSum> mean_;
    std::vector<SpectrumSum> squares_;
};

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
        PictureVariance variance;
        for (const auto& [seed, id] : cell.trials) variance.add(read_exr(store.image_of(id)));
        if (const auto mean = variance.mean()) result[name] = *mean;
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
