#include "experiments/run/caustic_ledger.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/light_path/aimed_emission.h"
#include "core/light_path/bounce_limit.h"
#include "core/reference/ordered_paths.h"

namespace caustics::experiments {

namespace {

/// Enough to tell 1 % of the light by a few percent of itself.
constexpr std::uint64_t paths_of_ledger = 20'000;
constexpr std::uint64_t paths_of_cut = 200'000;
constexpr double least_cut_looked_at = 0.002;

struct Landing {
    double watts;
    std::uint32_t shape;
    bool is_beyond;
};

LightLedger survey_paths_of(const OrderedPaths& paths, int limit, LightSurvey& survey) {
    const double share = 1 / static_cast<double>(paths.paths);
    return trace_in_order<Landing>(
               paths, RunOptions{},
               [&](const Deposit& d, std::uint64_t, std::vector<Landing>& all) {
                   all.push_back(
                       {static_cast<double>(d.flux.mean()) * share, d.shape, d.bounces > limit});
               },
               [&](const Landing& landing) {
                   if (landing.is_beyond)
                       survey.beyond += landing.watts;
                   else
                       survey.on_shape[landing.shape] += landing.watts;
               })
        .watts();
}

double resolved_or(const BuildReport& report, const char* name, double otherwise) {
    const auto found = report.resolved.find(name);
    return found == report.resolved.end() ? otherwise : found->second;
}

/// What beams did not follow is taken from what arrives, as far as it would, and else from what does not.
void take_out_pruned(double lost, double missed, LightLedger& light) {
    const double arriving = std::min(missed, light.arrived);
    const double elsewhere = std::max(0.0, lost - arriving);
    const double others = light.absorbed + light.escaped;
    const double kept = others > 0 ? std::max(0.0, 1 - elsewhere / others) : 1;
    light.arrived -= arriving;
    light.absorbed *= kept;
    light.escaped *= kept;
    light.pruned = light.sent - light.ended();
}

void count_beams(const BuildReport& report, CausticLedger& ledger) {
    const double lost = 1 - resolved_or(report, "flux_share_captured", 1);
    if (!(lost > 0)) return;
    const auto missed = report.resolved.find("flux_share_missed");
    ledger.missed_by_pruning =
        missed == report.resolved.end()
            ? lost * ledger.light.arrived
            : std::min(missed->second * ledger.light.sent, ledger.light.arrived);
    take_out_pruned(lost * ledger.light.sent, ledger.missed_by_pruning, ledger.light);
}

std::string on_receivers(const Scene& scene, const LightSurvey& survey) {
    std::string text;
    for (std::size_t i = 0; i < survey.on_shape.size(); ++i)
        if (survey.on_shape[i] > 0)
            text += fmt::format("{}{} {:.4g} W", text.empty() ? "" : ", ", scene.shapes()[i].name,
                                survey.on_shape[i]);
    return text;
}

std::string note_of_cut(int limit, double share) {
    return fmt::format(
        "max_bounces={} cuts {:.1f} % of the caustic, which arrives on receivers after more events "
        "(max_bounces={} keeps it)",
        limit, 100 * share, most_bounces);
}

std::string note_of_beams(const Method& method, const BuildReport& report, double share) {
    const double lost = 1 - resolved_or(report, "flux_share_captured", 1);
    const double pruned = resolved_or(report, "flux_share_pruned", 0);
    const double over_budget = resolved_or(report, "flux_share_over_budget", 0);
    const std::string beyond =
        over_budget > 0 && !report.resolved.contains("flux_share_rest")
            ? fmt::format("{:.1f} % in beams that max_beams has no room for, ", 100 * over_budget)
            : "";
    const bool has_rest = method.name == "beamtree";
    return fmt::format(
        "{} loses {:.1f} % of the caustic that would arrive on receivers ({:.1f} % of the light on "
        "casters: {:.1f} % in paths too weak to be followed, {}and the rest where polygons are too "
        "coarse for what they meet; {}photonmap follows it; max_bounces=1 asks for the paths with "
        "one event alone)",
        method.name, 100 * share, 100 * lost, 100 * pruned, beyond,
        has_rest ? "rest=photons completes it; " : "");
}

/// Where photons carry what `max_beams` leaves out though nobody asked for them.
std::optional<std::string> note_of_photons(const Method& method, const BuildReport& report) {
    const double carried = resolved_or(report, "flux_share_over_budget", 0);
    if (carried < least_share_of_note || !report.resolved.contains("flux_share_rest") ||
        describe(method).value("rest", "") == "photons")
        return {};
    return fmt::format(
        "max_beams has no room for beams with {:.1f} % of the light on casters: photons carry that "
        "light, with their noise (a larger max_beams takes more memory; rest=none leaves the light "
        "out)",
        100 * carried);
}

/// Where pencils carry what beams would take too long for.
std::optional<std::string> note_of_pencils(const BuildReport& report) {
    const double by_beams = resolved_or(report, "beam_share", 1);
    if (by_beams > 1 - least_share_of_note) return {};
    const bool only_pencils = by_beams < least_share_of_note;
    return fmt::format(
        "pencils (light paths with derivatives) carry {} of the caustic's light, and beams {}. "
        "More pencils make it sharper (pencils). Beams carry light of up to so many events by "
        "beam_events, and of all events by rest=max_beams",
        only_pencils ? "all" : fmt::format("{:.1f} %", 100 * (1 - by_beams)),
        only_pencils ? "none" : "the rest");
}

}  // namespace

LightSurvey survey_light(const Scene& scene, int max_bounces, std::uint64_t paths) {
    LightSurvey survey;
    survey.paths = paths;
    survey.on_shape.resize(scene.shapes().size());
    const AimedEmission emission(scene);
    if (emission.empty()) return survey;
    OrderedPaths traced{scene, emission, paths, max_bounces, 1, Stage::survey};
    survey.light = survey_paths_of(traced, max_bounces, survey);
    if (survey.light.cut == 0 || max_bounces == most_bounces) return survey;
    // The same paths, which go on.
    traced.max_bounces = most_bounces;
    LightSurvey further;
    further.on_shape.resize(scene.shapes().size());
    survey_paths_of(traced, max_bounces, further);
    survey.beyond = further.beyond;
    return survey;
}

double CausticLedger::whole() const {
    return light.arrived + missed_by_cut + missed_by_pruning + missed_by_normals;
}

double CausticLedger::share(double missed) const { return whole() > 0 ? missed / whole() : 0; }

int bounce_limit_of(const Method& method, const BuildReport& report) {
    const auto loaded = report.resolved.find("max_bounces");
    if (loaded != report.resolved.end()) return static_cast<int>(loaded->second);
    return describe(method).value("max_bounces", most_bounces);
}

std::optional<CausticLedger> caustic_ledger(const Scene& scene, const Method& method,
                                            const BuildReport& report) {
    if (!method.facts().has_caustic) return {};
    const int limit = bounce_limit_of(method, report);
    CausticLedger ledger;
    if (report.light) {
        ledger.light = *report.light;
    } else {
        ledger.is_survey = true;
        ledger.light = survey_light(scene, limit, paths_of_ledger).light;
    }
    const double sent = ledger.light.sent;
    if (!(sent > 0)) return {};
    if (limit < most_bounces && ledger.light.cut > least_cut_looked_at * ledger.light.arrived) {
        const LightSurvey survey = survey_light(scene, limit, paths_of_cut);
        if (survey.light.sent > 0) ledger.missed_by_cut = survey.beyond * sent / survey.light.sent;
    }
    count_beams(report, ledger);
    if (ledger.light.misdirected < sent)
        ledger.missed_by_normals =
            ledger.light.arrived * ledger.light.misdirected / (sent - ledger.light.misdirected);
    return ledger;
}

nlohmann::json to_json(const CausticLedger& ledger) {
    const LightLedger& light = ledger.light;
    nlohmann::json json = {{"sent", light.sent},
                           {"arrived", light.arrived},
                           {"is_survey", ledger.is_survey},
                           {"missed_by_cut", ledger.share(ledger.missed_by_cut)},
                           {"missed_by_pruning", ledger.share(ledger.missed_by_pruning)},
                           {"missed_by_normals", ledger.share(ledger.missed_by_normals)}};
    const std::pair<const char*, double> losses[] = {{"cut", light.cut},
                                                     {"pruned", light.pruned},
                                                     {"misdirected", light.misdirected},
                                                     {"absorbed", light.absorbed},
                                                     {"escaped", light.escaped}};
    for (const auto& [name, watts] : losses) {
        json[name] = watts;
        if (light.arrived > 0) json[std::string(name) + "_share"] = watts / light.arrived;
    }
    if (ledger.picture) json["picture"] = to_json(*ledger.picture);
    return json;
}

std::vector<std::string> notes_on_light(const Method& method, const BuildReport& report,
                                        const CausticLedger& ledger) {
    std::vector<std::string> all;
    const double cut = ledger.share(ledger.missed_by_cut);
    if (cut >= least_share_of_note)
        all.push_back(note_of_cut(bounce_limit_of(method, report), cut));
    const double pruned = ledger.share(ledger.missed_by_pruning);
    if (pruned >= least_share_of_note) all.push_back(note_of_beams(method, report, pruned));
    if (const auto photons = note_of_photons(method, report)) all.push_back(*photons);
    if (const auto pencils = note_of_pencils(report)) all.push_back(*pencils);
    if (!ledger.picture) return all;
    if (const auto sum = note_on(*ledger.picture)) all.push_back(*sum);
    return all;
}

std::string balance_text(const LightLedger& light) {
    return fmt::format(
        "sent {:.4g} W = arrived {:.4g} + cut at max_bounces {:.4g} + pruned {:.4g} + lost by "
        "shading normals {:.4g} + absorbed {:.4g} + escaped {:.4g}",
        light.sent, light.arrived, light.cut, light.pruned, light.misdirected, light.absorbed,
        light.escaped);
}

std::vector<std::string> lines_of(const Scene& scene, const LightSurvey& survey) {
    const LightLedger& light = survey.light;
    if (!(light.sent > 0)) return {};
    const auto percent = [&](double watts) { return 100 * watts / light.sent; };
    std::vector<std::string> lines = {fmt::format(
        "{:.4g} W come to casters, by {} light paths: {:.1f} % arrives on receivers, {:.1f} % is "
        "cut after {} events, {:.1f} % misdirected by smooth normals, {:.1f} % absorbed, {:.1f} % "
        "leaves the scene",
        light.sent, survey.paths, percent(light.arrived), percent(light.cut), most_bounces,
        percent(light.misdirected), percent(light.absorbed), percent(light.escaped))};
    if (const std::string where = on_receivers(scene, survey); !where.empty())
        lines.push_back("arrives on " + where);
    return lines;
}

}  // namespace caustics::experiments
