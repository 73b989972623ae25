#include "experiments/run/why_empty.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/light_path/empty_caustic.h"
#include "core/render/film.h"
#include "experiments/run/caustic_ledger.h"
#include "experiments/run/caustic_survey.h"

namespace caustics::experiments {

namespace {

bool is_dark(const Film& film) {
    for (std::size_t i = 0; i < film.pixel_count(); ++i)
        if (!is_black(film.rgb("caustic", i))) return false;
    return true;
}

std::optional<std::uint64_t> find(const Counters& counters, const std::string& name) {
    const auto found = counters.find(name);
    if (found == counters.end()) return {};
    return found->second;
}

/// The radius beyond which no photon is found, where the method has one [m].
std::optional<double> search_radius(const Method& method, const BuildReport& report) {
    const auto farthest = report.resolved.find("max_radius");
    if (farthest != report.resolved.end()) return farthest->second;
    const double fixed = describe(method).value("radius", 0.0);
    if (fixed > 0) return fixed;
    return {};
}

/// The camera sees lit receivers, but the method showed it nothing.
std::string why_missed(const Method& method, const CausticSurvey& survey, const BuildReport& report,
                       const Counters& counters) {
    const std::string found =
        fmt::format(" ({} of {} light paths traced to find out arrived where the camera sees them)",
                    survey.seen, survey.counts.emitted);
    if (counters.contains("beams") && !counters.contains("pencils_traced"))
        return fmt::format(
            "{} has no beam for it: the casters' polygons are too coarse for what they light{}",
            method.name, found);
    const std::optional<double> radius = search_radius(method, report);
    if (radius && find(counters, "empty_gathers") == find(counters, "gathers"))
        return fmt::format("no photon lies within {:.3g} m of what the camera sees{}", *radius,
                           found);
    return fmt::format("{} found none of the light that is there: give it more samples{}",
                       method.name, found);
}

}  // namespace

std::optional<std::string> why_empty(const Scene& scene, const Method& method, const Film& film,
                                     const BuildReport& report, const Counters& counters) {
    if (!method.facts().has_caustic || !is_dark(film)) return {};
    if (auto reason = why_nothing_is_aimed(scene)) return reason;
    const CausticSurvey survey = survey_caustic(scene, bounce_limit_of(method, report));
    const bool traces_light = counters.contains("photons_emitted");
    const LightPathCounts counts = traces_light ? light_path_counts(counters) : survey.counts;
    if (counts.stored == 0 && survey.counts.stored == 0) return why_nothing_arrives(counts);
    if (counts.stored == 0)
        return fmt::format(
            "{} light paths are too few to bring any: {} of {} traced to find out arrived",
            counts.emitted, survey.counts.stored, survey.counts.emitted);
    if (find(counters, "receiver_points") == 0) return "the camera sees no receiver";
    if (counters.contains("photons_connected") && survey.behind_caster > 0 && survey.seen == 0)
        return fmt::format(
            "the camera sees what light reaches through casters at most, where {} cannot connect "
            "the two (layer unreached; photonmap can)",
            method.name);
    if (survey.seen == 0) return why_unseen(survey);
    return why_missed(method, survey, report, counters);
}

}  // namespace caustics::experiments
