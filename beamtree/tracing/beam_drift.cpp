#include "beamtree/tracing/beam_drift.h"

#include <algorithm>

#include "core/base/interrupt.h"

namespace caustics::beamtree {
namespace {

LightSample at_end(LightSample light, double place) {
    light.bin.nm = static_cast<float>(light.places.wavelength_at(place));
    return light;
}

// As far from a ray as another one, on the other side.
VertexRay beyond(const VertexRay& from, const VertexRay& middle) {
    return {2 * middle.position - from.position,
            (2 * middle.direction - from.direction).normalized()};
}

/// How far a curved surface may lie off the straight line that a ray's start moves along between the ends of the bin, where
/// it starts at `point` at one of them: chord times turn over 4, as of polygons, both twice those to the middle.
float bulge_between(const PathPoint& point, const VertexRay& middle, const Departure& from) {
    if (!point.alive) return 0;
    return (point.ray.position - middle.position).norm() * (point.from.normal - from.normal).norm();
}

/// Half of what the ray at the longest wavelength differs by from that at the shortest.
struct Drift {
    Vec3 position = Vec3::Zero();
    Vec3 direction = Vec3::Zero();
};

}  // namespace

void DriftAccount::add(const DriftAccount& other) {
    rays += other.rays;
    unknown += other.unknown;
    bend = std::max(bend, other.bend);
}

BeamDrift::BeamDrift(const Scene& scene, const CasterMesh& caster, const LightSample& light)
    : scene_(scene),
      lights_{at_end(light, -1), at_end(light, 1)},
      ends_{LitCaster(scene, caster, lights_[0]), LitCaster(scene, caster, lights_[1])} {}

DriftAccount BeamDrift::add_to(Level& level, const std::vector<bool>& kept) const {
    BeamSet& set = level.traced.set;
    set.ends = {set.rays, set.rays};
    std::vector<Known> known(set.rays.size(), Known::not_asked);
    std::vector<float> bulges(set.rays.size(), 0);
    DriftAccount account;
    for (std::uint32_t beam = 0; beam < set.beams.size(); ++beam) {
        if (!kept[beam]) continue;
        throw_if_interrupted();
        const Path first(scene_, ends_[0], level, beam);
        const Path last(scene_, ends_[1], level, beam);
        for (const std::uint32_t ray : set.beams[beam].corners) {
            if (ray == Beam::none || known[ray] != Known::not_asked) continue;
            const PathPoint a = first.from(level.traced.origins[ray]);
            const PathPoint b = last.from(level.traced.origins[ray]);
            const VertexRay& middle = set.rays[ray];
            bulges[ray] = std::max(bulge_between(a, middle, level.departures[ray]),
                                   bulge_between(b, middle, level.departures[ray]));
            account.rays += 1;
            known[ray] = a.alive || b.alive ? Known::yes : Known::no;
            if (known[ray] == Known::no) continue;
            set.ends[0][ray] = a.alive ? a.ray : beyond(b.ray, middle);
            set.ends[1][ray] = b.alive ? b.ray : beyond(a.ray, middle);
            if (!a.alive || !b.alive) continue;
            const Vec3 mean = (a.ray.direction + b.ray.direction) / 2;
            account.bend =
                std::max(account.bend, static_cast<double>((mean - middle.direction).norm()));
        }
    }
    for (Beam& beam : set.beams) {
        float largest = 0;  // its surface must not be in its own light's way
        for (const std::uint32_t ray : beam.corners)
            if (ray != Beam::none) largest = std::max(largest, bulges[ray]);
        beam.offset += largest;
    }
    for (std::uint32_t beam = 0; beam < set.beams.size(); ++beam)
        if (kept[beam]) account.unknown += guess(set, set.beams[beam], known);
    return account;
}

double BeamDrift::guess(BeamSet& set, const Beam& beam, std::vector<Known>& known) {
    Drift mean;
    float count = 0;
    for (const std::uint32_t ray : beam.corners) {
        if (ray == Beam::none || known[ray] != Known::yes) continue;
        mean.position += (set.ends[1][ray].position - set.ends[0][ray].position) / 2;
        mean.direction += (set.ends[1][ray].direction - set.ends[0][ray].direction) / 2;
        ++count;
    }
    double guessed = 0;
    for (const std::uint32_t ray : beam.corners) {
        if (ray == Beam::none || known[ray] != Known::no) continue;
        guessed += 1;
        known[ray] = Known::guessed;
        if (count == 0) continue;
        const VertexRay& middle = set.rays[ray];
        set.ends[0][ray] = {middle.position - mean.position / count,
                            (middle.direction - mean.direction / count).normalized()};
        set.ends[1][ray] = beyond(set.ends[0][ray], middle);
    }
    return guessed;
}

}  // namespace caustics::beamtree
