#include "beamtree/beams/light_sample.h"

#include <algorithm>
#include <cmath>

#include "beamtree/beams/area_light_points.h"
#include "beamtree/beams/bin_share.h"
#include "beamtree/beams/solid_angle.h"
#include "core/math/rng.h"

namespace caustics::beamtree {
namespace {

void sample_area_light(const Scene& scene, const AreaLight& light, LightSample sample, int count,
                       Rng rng, std::vector<LightSample>& samples) {
    sample.kind = LightSample::Kind::area;
    for (const AreaLightPoint& point : area_light_points(scene, light, count, rng)) {
        sample.strength = light.radiance * static_cast<float>(point.area);
        sample.position = point.position;
        sample.normal = point.normal;
        sample.area = point.area;
        sample.offset = point.offset;
        samples.push_back(sample);
    }
}

LightSample sample_of(const LightPoint& point, const Scene& scene, LightSample sample) {
    sample.strength = point.strength;
    sample.spot = point.spot;
    if (point.position) {
        sample.position = *point.position;
        return sample;
    }
    sample.kind = LightSample::Kind::directional;
    sample.travel = point.travel;
    sample.bounds = scene.bounds();
    return sample;
}

}  // namespace

std::vector<LightSample> sample_lights(const Scene& scene, int per_area_light, std::uint64_t seed) {
    std::vector<LightSample> samples;
    for (std::uint32_t i = 0; i < scene.lights().size(); ++i) {
        const Light& light = scene.lights()[i];
        LightSample sample;
        sample.light = i;
        sample.medium = scene.light_media()[i].absorption;
        if (const auto point = point_of(light)) {
            samples.push_back(sample_of(*point, scene, sample));
        } else if (const auto* area = std::get_if<AreaLight>(&light)) {
            sample_area_light(scene, *area, sample, per_area_light, Rng(seed, Stage::beams, i),
                              samples);
        }
    }
    return samples;
}

std::vector<LightSample> dispersed(const std::vector<LightSample>& samples, int wavelengths) {
    std::vector<LightSample> parts;
    const std::vector<WavelengthBin> bins = wavelength_bins(wavelengths);
    for (const LightSample& sample : samples)
        for (const WavelengthBin& bin : bins) {
            parts.push_back(sample);
            parts.back().bin = bin;
            parts.back().strength *= bin.weight;
        }
    return parts;
}

std::vector<LightSample> drifting(const std::vector<LightSample>& samples, int wavelengths,
                                  const Ior& glass) {
    std::vector<BinPlaces> places;
    for (const WavelengthBin& bin : wavelength_bins(wavelengths)) places.emplace_back(bin, glass);
    std::vector<LightSample> parts = dispersed(samples, wavelengths);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        parts[i].drifts = true;
        parts[i].places = places[i % places.size()];
        parts[i].bin.nm = static_cast<float>(parts[i].places.wavelength_at(0));
    }
    return parts;
}

Spectrum share_of_wavelengths(const LightSample& light, double from, double to, float nm) {
    const WavelengthBin& bin = light.bin;
    if (bin.nm == 0 || !light.drifts) return share_of_bin(bin, nm);
    if (nm == 0)
        return channel_integral(light.places.wavelength_at(from), light.places.wavelength_at(to))
                   .cast<float>() *
               whitened(bin);
    const double place = light.places.place_of(static_cast<double>(nm));
    if (place < from || place >= to) return black();
    return share_of_bin(bin, nm);
}

Vec3 to_light(const LightSample& light, const Vec3& point) {
    if (light.kind == LightSample::Kind::directional) return -light.travel;
    const Vec3 towards = light.position - point;
    const float distance = towards.norm();
    return distance > 0 ? Vec3(towards / distance) : Vec3::Zero();
}

float distance_from(const LightSample& light, const Vec3& point) {
    if (light.kind == LightSample::Kind::directional)
        return -distance_to_entry(light.bounds, point, light.travel);
    return (light.position - point).norm();
}

Spectrum strength_along(const LightSample& light, const Vec3& w) {
    if (light.spot) return light.strength * light.spot->falloff(-w);
    if (light.kind != LightSample::Kind::area) return light.strength;
    return light.strength * std::max(0.0F, -light.normal.dot(w));
}

double measure(const LightSample& light, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3d p = a.cast<double>();
    const Vec3d q = b.cast<double>();
    const Vec3d r = c.cast<double>();
    if (light.kind == LightSample::Kind::directional) {
        const Vec3d cross = (q - p).cross(r - p);
        return std::abs(cross.dot(light.travel.cast<double>())) / 2;
    }
    const Vec3d from = light.position.cast<double>();
    return std::abs(solid_angle(p - from, q - from, r - from));
}

bool sees(const Scene& scene, const SegmentEnd& point, const LightSample& light) {
    if (light.kind == LightSample::Kind::directional)
        return !scene.occluded_along(point, -light.travel);
    return !scene.occluded(point, {light.position, light.normal, light.offset});
}

}  // namespace caustics::beamtree
