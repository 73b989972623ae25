#include "experiments/report/cell_variance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/interrupt.h"
#include "experiments/base/child_process.h"
#include "experiments/picture/metrics.h"
#include "experiments/picture/previews.h"
#include "experiments/plan/sweep_plan.h"
#include "experiments/plan/trial_store.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;

/// Gathers the sample variance over pictures, one at a time (Welford 1962).
class PictureVariance {
public:
    /// Whether a picture is of the size of those before and of the reference.
    bool takes(const Film& film) const {
        return reached_.empty() || film.pixel_count() == reached_.size();
    }
    void add(const Film& film) {
        leave_out_unreached(film);
        if (count_ == 0) {
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
    /// A pixel that any picture or the reference cannot reach does not count.
    void leave_out_unreached(const Film& film) {
        const PixelMask reached = reached_pixels(film, film);
        reached_ = reached_.empty() ? reached : intersection(reached_, reached);
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

/// What a variance stands on.
struct CellPictures {
    std::map<std::uint64_t, std::string> trials;  ///< one a seed
    std::string reference;                        ///< key; empty: there is none
    std::filesystem::path reference_file;         ///< empty: not to be found

    bool lacks_reference() const { return !reference.empty() && reference_file.empty(); }
};

/// Where a reference lies: in the folder's own cache, or in that kept beside a sweep file.
std::filesystem::path reference_file(const PlanFile& plan, const std::filesystem::path& folder,
                                     const std::string& key) {
    const std::string name = key + ".exr";
    std::vector<std::filesystem::path> places = {folder / "references" / name};
    for (const std::string& sweep : plan.sweeps)
        places.push_back(kept_references(plan.started_in / sweep) / name);
    const auto found = std::ranges::find_if(
        places, [](const auto& file) { return std::filesystem::is_regular_file(file); });
    return found == places.end() ? std::filesystem::path() : *found;
}

std::map<std::string, CellPictures> cells_of(const PlanFile& plan,
                                             const std::filesystem::path& folder,
                                             const DonePictures& done) {
    std::map<std::string, CellPictures> cells;
    for (const PlanFile::Entry& trial : plan.trials) {
        const auto picture = done.find(trial.id);
        if (picture == done.end()) continue;
        cells[trial.cell].trials.emplace(trial.seed, trial.id);
        cells[trial.cell].reference = picture->second.reference;
    }
    std::erase_if(cells, [](const auto& cell) { return cell.second.trials.size() < 2; });
    for (auto& [name, cell] : cells)
        if (!cell.reference.empty())
            cell.reference_file = reference_file(plan, folder, cell.reference);
    return cells;
}

std::string hash_of(const CellPictures& cell, const DonePictures& done) {
    std::uint64_t hash =
        fnv1a(fmt::format("{} {}\n", cell.reference, cell.lacks_reference() ? "missing" : ""));
    for (const auto& [seed, id] : cell.trials)
        hash = fnv1a(fmt::format("{} {}\n", seed, done.at(id).hash), hash);
    return hex(hash);
}

/// A number, null where no pixel counts, or text where a picture cannot be used.
json variance_of(const CellPictures& cell, const TrialStore& store) {
    if (cell.lacks_reference()) return {};
    std::vector<std::filesystem::path> files;
    for (const auto& [seed, id] : cell.trials) files.push_back(store.image_of(id));
    PictureVariance variance;
    try {
        if (!cell.reference_file.empty())
            variance.leave_out_unreached(read_exr(cell.reference_file));
        for (const std::filesystem::path& file : files) {
            const Film film = read_caustic(file);
            if (!variance.takes(film))
                return file.string() + ": of another size than others of its cell";
            variance.add(film);
        }
    } catch (const InputError& error) {
        return error.what();
    }
    const std::optional<double> mean = variance.mean();
    return mean ? json(*mean) : json();
}

json variances_of(const std::map<std::string, CellPictures>& cells, const TrialStore& store) {
    json result = json::object();
    for (const auto& [name, cell] : cells) result[name] = variance_of(cell, store);
    return result;
}

}  // namespace

CellVariances cell_variances(const PlanFile& plan, const std::filesystem::path& folder,
                             const DonePictures& done, const CellVariances& earlier) {
    CellVariances all;
    std::map<std::string, CellPictures> fresh;
    for (const auto& [name, cell] : cells_of(plan, folder, done)) {
        const auto known = earlier.find(name);
        if (known != earlier.end() && known->second.pictures == hash_of(cell, done))
            all.insert(*known);
        else
            fresh.emplace(name, cell);
    }
    // The table of a sweep that was stopped does without.
    if (fresh.empty() || interrupt_requested()) return all;
    const TrialStore store(folder);
    const json means = json::parse(run_in_child([&](const ChildProcess::Tell&) {
        return variances_of(fresh, store).dump(-1, ' ', false, json::error_handler_t::replace);
    }));
    for (const auto& [name, cell] : fresh) {
        CellVariance& variance = all[name];
        variance.pictures = hash_of(cell, done);
        if (means.at(name).is_number()) variance.mean = means.at(name).get<double>();
        if (means.at(name).is_string()) variance.unreadable = means.at(name).get<std::string>();
    }
    return all;
}

}  // namespace caustics::experiments
