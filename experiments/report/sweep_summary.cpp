#include "experiments/report/sweep_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "experiments/base/progress.h"
#include "experiments/plan/record.h"
#include "experiments/run/method.h"

namespace caustics::experiments {

SweepSummary::SweepSummary(const std::vector<std::string>& swept) {
    for (const std::string& key : swept) swept_.push_back(column_of_swept(key));
}

SweepSummary::Values SweepSummary::values_of(const TableRow& row) const {
    Values values;
    for (const std::string& key : swept_)
        if (const std::string& value = row.text(key); !value.empty()) values[key] = value;
    return values;
}

std::string SweepSummary::words(const Values& values) const {
    std::vector<std::string> parts;
    for (const std::string& key : swept_)
        if (const auto found = values.find(key); found != values.end())
            parts.push_back(fmt::format("{} {}", key, found->second));
    return fmt::format("{}", fmt::join(parts, ", "));
}

void SweepSummary::Range::take_in(std::optional<double> value) {
    if (!value) return;
    low = std::min(low, *value);
    high = std::max(high, *value);
}

void SweepSummary::add(const TableRow& row) {
    ++statuses_[row.text("status")];
    seconds_.take_in(row.number("total_s"));
    if (const std::optional<double> bytes = row.number("peak_rss_bytes"))
        memory_.take_in(*bytes / (1 << 20));
    reference_error_.take_in(row.number("reference_stderr"));
    const MethodDescription* const method = find_method(row.text("method"));
    if (method == nullptr || method->facts().has_caustic) energy_.take_in(row.number("mean_ratio"));
    const std::optional<double> rmse = row.number("rmse");
    if (!rmse) return;
    const Values values = values_of(row);
    // Errors over other pixels are not compared; how many a method leaves out varies a little by seed.
    const std::string judge = fmt::format("{} {:.2f}", row.text("reference"),
                                          row.number("unreached_fraction").value_or(0));
    const auto [place, is_first] =
        scenes_[row.text("scene")].try_emplace(judge, Judged{{}, values});
    Judged& judged = place->second;
    std::erase_if(judged.common, [&](const auto& item) {
        const auto found = values.find(item.first);
        return found == values.end() || found->second != item.second;
    });
    if (*rmse < judged.best.rmse) judged.best = {*rmse, row.text("method"), values};
}

std::string SweepSummary::Range::text() const { return fmt::format("{:.4g} to {:.4g}", low, high); }

std::string SweepSummary::statuses_text() const {
    std::vector<std::string> parts;
    for (const auto& [status, count] : statuses_)
        parts.push_back(fmt::format("{} {}", count, status));
    return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", "));
}

/// "ring, alpha 0.1: 0.0123 (photonmap, photons 10000, nearest 50)".
std::string SweepSummary::best_line(const std::string& scene, const Judged& judged) const {
    Values own = judged.best.values;
    std::erase_if(own, [&](const auto& item) { return judged.common.contains(item.first); });
    // What is the same everywhere says nothing.
    Values setting = judged.common;
    std::erase_if(setting, [&](const auto& item) {
        return std::ranges::all_of(scenes_, [&](const auto& each) {
            return std::ranges::all_of(each.second, [&](const auto& other) {
                const auto found = other.second.common.find(item.first);
                return found != other.second.common.end() && found->second == item.second;
            });
        });
    });
    return fmt::format("{}{}{}: {:.4g} ({}{}{})", scene, setting.empty() ? "" : ", ",
                       words(setting), judged.best.rmse, judged.best.method,
                       own.empty() ? "" : ", ", words(own));
}

/// The lowest error of each scene as it was set.
std::string SweepSummary::best_text() const {
    constexpr std::size_t most = 12;
    std::vector<std::string> lines;
    for (const auto& [scene, settings] : scenes_)
        for (const auto& [reference, judged] : settings) lines.push_back(best_line(scene, judged));
    std::ranges::sort(lines);
    if (lines.size() > most + 1) {
        const std::size_t more = lines.size() - most;
        lines.resize(most);
        lines.push_back(fmt::format("and {} more settings (records.csv has them)", more));
    }
    return fmt::format("{}", fmt::join(lines, "\n           "));
}

/// The lines on errors, or why there are none.
std::string SweepSummary::errors_text() const {
    if (!statuses_.contains("done")) return "errors     none: no trial is done\n";
    if (scenes_.empty())
        return "errors     none: the sweep has no reference (\"reference\" in the sweep file asks "
               "for "
               "one)\n";
    std::string text = fmt::format("best RMSE  {}\n", best_text());
    if (!energy_.is_empty())
        text += fmt::format("energy     mean(caustic) / mean(reference) from {}\n", energy_.text());
    if (!reference_error_.is_empty())
        text += fmt::format("references standard error a pixel {} of the mean\n",
                            reference_error_.text());
    return text;
}

std::string SweepSummary::text(std::size_t planned, std::size_t ran, double seconds) const {
    std::string text = fmt::format("trials     {} planned: {}; {} run now in {}\n", planned,
                                   statuses_text(), ran, clock_text(seconds));
    text += errors_text();
    if (!seconds_.is_empty())
        text += fmt::format("time       a trial takes {} s, peak memory {} MiB\n", seconds_.text(),
                            memory_.text());
    return text;
}

}  // namespace caustics::experiments
