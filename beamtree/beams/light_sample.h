#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "beamtree/beams/bin_places.h"
#include "core/scene/scene.h"

namespace caustics::beamtree {

/// How beams tell wavelengths apart.
enum class Dispersion {
    bins,      ///< all light of a bin goes the way of its mean wavelength
    intervals  ///< a point asks for which wavelengths of the bin a caustic polygon holds it
};

/// What a set of beams starts from: a point light, a direction, or one point of an area light.
struct LightSample {
    enum class Kind { point, directional, area };
    Kind kind = Kind::point;
    Vec3 position = Vec3::Zero();  ///< of a point or area sample
    Vec3 travel = Vec3::Zero();    ///< of a directional light: unit, the way the light goes
    Vec3 normal = Vec3::Zero();    ///< unit, of the area light there; else zero
    float offset = 0;              ///< of rays that leave the area light [m]
    double area = 0;               ///< of the area light's part that it stands for [m^2]
    Box bounds;                    ///< directional: of the scene, outside of which its rays begin
    Spectrum strength = black();   ///< point [W/sr]; area [W/sr] along the normal;
                                   ///< directional [W/m^2] across the direction
    std::optional<SpotCone> spot;  ///< of a point light that is one
    std::uint32_t light = 0;       ///< index into Scene::lights
    const Spectrum* medium = nullptr;  ///< absorption [1/m] where it shines (Scene::light_media)
    WavelengthBin bin = {};  ///< its part of all wavelengths where glass disperses it; nm 0: all
    bool drifts = false;     ///< its beams tell each wavelength of the bin apart (BeamSet::ends)
    BinPlaces places = {};   ///< of wavelengths, where it drifts
};

/// For all lights but constant ones: one sample a point or directional light, at most `per_area_light` samples an
/// area light, drawn by the seed (area_light_points()).
std::vector<LightSample> sample_lights(const Scene& scene, int per_area_light, std::uint64_t seed);
/// The same light in parts: each sample once a bin of wavelengths (WavelengthBin), with its share of the
/// strength.
std::vector<LightSample> dispersed(const std::vector<LightSample>& samples, int wavelengths);
/// Likewise, of light that drifts, with places by a glass.
std::vector<LightSample> drifting(const std::vector<LightSample>& samples, int wavelengths,
                                  const Ior& glass);

/// What the sample's light between two places in its bin (BinPlaces; all of it where it
/// does not drift) counts for a viewer, behind glass that has chosen the wavelength nm, for which light of
/// all others is black, or of all wavelengths (0).
Spectrum share_of_wavelengths(const LightSample& light, double from, double to, float nm);

/// Unit direction from a point to the light.
Vec3 to_light(const LightSample& light, const Vec3& point);
/// Distance that the light has gone to a point [m]: what absorption on the way acts on.
float distance_from(const LightSample& light, const Vec3& point);
/// Strength towards a point that sees the light along the unit direction `w` (cosine of an area
/// light and falloff of a spot light included).
Spectrum strength_along(const LightSample& light, const Vec3& w);
/// What the strength is multiplied by for the flux onto a triangle: its solid angle [sr] (Van
/// Oosterom and Strackee 1983), or for a directional light its area across the direction [m^2].
double measure(const LightSample& light, const Vec3& a, const Vec3& b, const Vec3& c);
/// Whether nothing stands between a surface point and the light.
bool sees(const Scene& scene, const SegmentEnd& point, const LightSample& light);

}  // namespace caustics::beamtree
