#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/counters.h"
#include "core/light_ledger.h"
#include "core/scene/scene.h"
#include "experiments/run/method.h"
#include "experiments/run/picture_light.h"

namespace caustics::experiments {

/// The least share of the caustic that is told where it is lost or made.
inline constexpr double least_share_of_note = 0.01;

/// What light paths that are traced to find out bring to the receivers of a scene.
struct LightSurvey {
    LightLedger light;             ///< of paths with the limit of events that was asked for
    double beyond = 0;             ///< arrives after more events than that [W]
    std::vector<double> on_shape;  ///< arrives on each shape within the limit [W]
    std::uint64_t paths = 0;
};

/// The same for every call with the same arguments.
LightSurvey survey_light(const Scene& scene, int max_bounces, std::uint64_t paths);

/// The ledger of a picture's caustic, and the light that its receivers miss.
struct CausticLedger {
    LightLedger light;             ///< as the method counted it, or else as a survey tells
    bool is_survey = false;        ///< the second
    double missed_by_cut = 0;      ///< would arrive after more than `max_bounces` events [W]
    double missed_by_pruning = 0;  ///< would arrive, if beams were followed to their end [W]
    double missed_by_normals = 0;  ///< would arrive, if as much of it did as of other light [W]
    std::optional<PictureLight> picture = {};  ///< of a picture: what its caustic adds up to

    /// All light that would arrive [W].
    double whole() const;
    /// Share of that light.
    double share(double missed) const;
};

/// The ledger of a method that was built with that report; none where no light is sent to casters, or the method has no
/// caustic.
std::optional<CausticLedger> caustic_ledger(const Scene& scene, const Method& method,
                                            const BuildReport& report);

/// The limit of events that the method's light paths were under.
int bounce_limit_of(const Method& method, const BuildReport& report);

/// Watts by name, shares of what arrives ("cut_share"), and shares of the caustic that are missed ("missed_by_cut").
nlohmann::json to_json(const CausticLedger& ledger);

/// One line each on light that the caustic misses, from 1 % of the caustic on: how much, why, and the way out.
std::vector<std::string> notes_on_light(const Method& method, const BuildReport& report,
                                        const CausticLedger& ledger);

/// The ledger in one line: "sent 2 W = arrived 1.5 + cut 0.1 + ...".
std::string balance_text(const LightLedger& light);

/// The ledger for a person, a line each: what is sent, what becomes of it, and how much arrives on which receiver.
std::vector<std::string> lines_of(const Scene& scene, const LightSurvey& survey);

}  // namespace caustics::experiments
