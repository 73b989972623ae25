#include "experiments/run/caustic_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/light_path/aimed_emission.h"
#include "core/reference/ordered_paths.h"

namespace caustics::experiments {

namespace {

constexpr std::uint64_t survey_paths = 20'000;

using Kind = std::uint64_t CausticSurvey::*;

/// Which kind of arrival a deposit is.
class Onlooker {
public:
    explicit Onlooker(const Scene& scene) : scene_(scene), film_(scene.camera()) {}

    Kind kind_of(const Deposit& d) const {
        if (is_black(albedo(scene_.shapes()[d.shape].bsdf, d.uv))) return &CausticSurvey::on_black;
        if (!film_.project(d.position)) return &CausticSurvey::outside;
        const Vec3 to_eye = scene_.camera().position() - d.position;
        const float distance = to_eye.norm();
        const Vec3 wo = to_eye / distance;
        if (d.geometric_normal.dot(wo) <= 0 || d.shading_normal.dot(wo) <= 0)
            return &CausticSurvey::turned_away;
        Ray ray = spawn_ray({d.position, d.geometric_normal, d.offset}, wo);
        ray.max_distance = distance;
        const std::optional<SurfacePoint> between = scene_.intersect(ray);
        if (!between) return &CausticSurvey::seen;
        return is_caster(scene_.shape_at(*between).bsdf) ? &CausticSurvey::behind_caster
                                                         : &CausticSurvey::hidden;
    }

private:
    const Scene& scene_;
    FilmProjection film_;
};

}  // namespace

CausticSurvey survey_caustic(const Scene& scene, int max_bounces) {
    const AimedEmission emission(scene);
    const Onlooker onlooker(scene);
    const OrderedPaths paths{scene, emission, survey_paths, max_bounces, 1, Stage::survey};
    CausticSurvey survey;
    survey.counts = trace_in_order<Kind>(
        paths, RunOptions{},
        [&](const Deposit& d, std::uint64_t, std::vector<Kind>& kinds) {
            kinds.push_back(onlooker.kind_of(d));
        },
        [&](Kind kind) { ++(survey.*kind); });
    return survey;
}

std::string why_unseen(const CausticSurvey& survey) {
    const std::uint64_t most = std::max(
        {survey.on_black, survey.outside, survey.turned_away, survey.hidden, survey.behind_caster});
    const char* reason = "what light reaches is hidden from the camera by other surfaces";
    if (most == survey.on_black)
        reason = "the receivers that light reaches reflect none of it";
    else if (most == survey.outside)
        reason = "what light reaches is outside of the picture";
    else if (most == survey.turned_away)
        reason = "light reaches receivers on the side that the camera does not see";
    else if (most == survey.behind_caster)
        reason = "the camera sees what light reaches through casters at most";
    return fmt::format(
        "{} ({} light paths traced to find out: {} arrived on black, {} outside of the picture, {} "
        "on the other side, {} hidden, {} behind casters)",
        reason, survey.counts.emitted, survey.on_black, survey.outside, survey.turned_away,
        survey.hidden, survey.behind_caster);
}

}  // namespace caustics::experiments
