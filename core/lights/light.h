#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/lights/area_light.h"
#include "core/lights/constant_light.h"
#include "core/lights/directional_light.h"
#include "core/lights/point_light.h"
#include "core/lights/spot_light.h"

namespace caustics {

/// The kinds of lights. A new one is a file of its own and a place in this list. What is asked of a kind:
/// - `family`: its place among a scene's lights, and its number in transport hashes;
/// - `text`, `read`: its keys in a scene file, and itself, relative to the scene's origin;
/// - `line`: what `info` prints; `add_to`: what a photon map depends on;
/// - `aim`, `send`: sources of light for the casters [W], and a ray of one (none: it is thinned out);
/// - `start`, where sources have targets: the place that a ray starts from;
/// - `arrival`, but for what is met by chance alone: what comes straight to a place;
/// - `point`, where its light comes from one point or direction; beams start there;
/// - `background`, where rays that meet nothing find it;
/// - `scale`, `to_mitsuba`, `to_povray`, but for a shape's: other strength, other programs.
using Light = std::variant<PointLight, SpotLight, DirectionalLight, ConstantLight, AreaLight>;

int family_of(const Light& light);
/// The `type` in scene files.
std::string type_of(const Light& light);
std::string line_of(const Light& light, const Surroundings& scene, const Vec3d& origin);
void add_to(ValueHash& hash, const Light& light);
std::vector<AimedSource> aim(const Light& light, const Surroundings& scene);
/// The place that a ray starts from of a source with targets: two numbers.
SegmentEnd start_of(const Light& light, const Surroundings& scene, const AimedSource& source,
                    Rng& rng);
std::optional<Ray> send(const Light& light, const Surroundings& scene, const AimedSource& source,
                        const AimedSample& sample, Rng& rng);
std::optional<LightArrival> arrival_from(const Light& light, const Surroundings& scene,
                                         const Vec3& at, Rng& rng);
std::optional<LightPoint> point_of(const Light& light);
/// Whether it shines from everywhere, and what rays find that meet nothing: black but for such [W m^-2 sr^-1].
bool surrounds(const Light& light);
Spectrum background_of(const Light& light);
/// Whether directions chosen at random can meet it.
bool has_extent(const Light& light);
/// Other than a shape's.
void scale(Light& light, const Spectrum& factor);
MitsubaEmitter to_mitsuba(const Light& light);
PovrayLight to_povray(const Light& light, const Surroundings& scene);

/// Types that a scene file holds as objects of their own.
const std::vector<std::string>& light_types();
Light read_light(const std::string& type, const JsonNode& node, const Vec3d& origin);
/// All kinds, `ambient` among them, with their keys.
scene_file::Objects light_keys();

}  // namespace caustics
