#include "experiments/cell_variance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/error.h"
#include "core/hash.h"
#include "experiments/child_process.h"
#include "experiments/interrupt.h"
#include "experiments/metrics.h"
#include "experiments/pictures.h"

namespace caustics {

namespace {

using nlohmann::json;

/// Gathers the sample variance over pictures, one at a time (Welford 1962).
class PictureVariance {
public:
    /// Of pictures of one size.
    bool takes(const Film& film) const { return count_ == 0 || film.pixel_count() == mean_.size(); }
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

/// The trials whose pictures a variance stands on, one a seed.
using CellTrials = std::map<std::uint64_t, std::string>;

std::map<std::string, CellTrials> cells_of(const PlanFile& plan, const DonePictures& done) {
    std::map<std::string, CellTrials> cells;
    for (const PlanFile::Entry& trial : plan.trials)
        if (done.contains(trial.id)) cells[trial.cell].emplace(trial.seed, trial.id);
    std::erase_if(cells, [](const auto& cell) { return cell.second.size() < 2; });
    return cells;
}

std::string hash_of(const CellTrials& trials, const DonePictures& done) {
    std::uint64_t hash = fnv1a("");
    for (const auto& [seed, id] : trials)
        hash = fnv1a(fmt::format("{} {}\n", seed, done.at(id)), hash);
    return hex(hash);
}

/// A number, null where no pixel is reached, or text where a picture cannot be used.
json variance_of(const CellTrials& trials, const JobStore& store) {
    PictureVariance variance;
    for (const auto& [seed, id] : trials) {
        const std::filesystem::path file = store.image_of(id);
        try {
            const Film film = read_caustic(file);
            if (!variance.takes(film))
                return file.string() + ": of another size than others of its cell";
            variance.add(film);
        } catch (const InputError& error) {
            return error.what();
        }
    }
    const std::optional<double> mean = variance.mean();
    return mean ? json(*mean) : json();
}

json variances_of(const std::map<std::string, CellTrials>& cells, const JobStore& store) {
    json result = json::object();
    for (const auto& [name, trials] : cells) result[name] = variance_of(trials, store);
    return result;
}

}  // namespace

CellVariances cell_variances(const PlanFile& plan, const JobStore& store, const DonePictures& done,
                             const CellVariances& earlier) {
    CellVariances all;
    std::map<std::string, CellTrials> fresh;
    for (const auto& [name, trials] : cells_of(plan, done)) {
        const auto known = earlier.find(name);
        if (known != earlier.end() && known->second.pictures == hash_of(trials, done))
            all.insert(*known);
        else
            fresh.emplace(name, trials);
    }
    // The table of a sweep that was stopped does without.
    if (fresh.empty() || interrupt_requested()) return all;
    const json means = json::parse(run_in_child([&](const ChildProcess::Tell&) {
        return variances_of(fresh, store).dump(-1, ' ', false, json::error_handler_t::replace);
    }));
    for (const auto& [name, trials] : fresh) {
        CellVariance& variance = all[name];
        variance.pictures = hash_of(trials, done);
        if (means.at(name).is_number()) variance.mean = means.at(name).get<double>();
        if (means.at(name).is_string()) variance.unreadable = means.at(name).get<std::string>();
    }
    return all;
}

}  // namespace caustics
