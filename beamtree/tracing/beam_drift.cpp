#include "beamtree/tracing/beam_drift.h"

#include <algorithm>

namespace caustics {
namespace {

LightSample at_end(LightSample light, double place) {
    light.bin.nm = static_cast<float>(light.bin.wavelength_at(place));
    return light;
}

VertexRay half_way(const VertexRay& from, const VertexRay& to, float share) {
    return {share * (to.position - from.position), share * (to.direction - from.direction)};
}

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
    const VertexRay none{Vec3::Zero(), Vec3::Zero()};
    BeamSet& set = level.traced.set;
    set.drifts.assign(set.rays.size(), none);
    std::vector<bool> asked(set.rays.size());
    std::vector<bool> known(set.rays.size());
    DriftAccount account;
    for (std::uint32_t beam = 0; beam < set.beams.size(); ++beam) {
        if (!kept[beam]) continue;
        const Path first(scene_, ends_[0], level, beam);
        const Path last(scene_, ends_[1], level, beam);
        for (const std::uint32_t ray : set.beams[beam].corners) {
            if (ray == Beam::none || asked[ray]) continue;
            asked[ray] = true;
            const PathPoint a = first.from(level.traced.origins[ray]);
            const PathPoint b = last.from(level.traced.origins[ray]);
            const VertexRay& middle = set.rays[ray];
            account.rays += 1;
            known[ray] = a.alive || b.alive;
            if (a.alive && b.alive) {
                set.drifts[ray] = half_way(a.ray, b.ray, 0.5F);
                const Vec3 mean = (a.ray.direction + b.ray.direction) / 2;
                account.bend =
                    std::max(account.bend, static_cast<double>((mean - middle.direction).norm()));
            } else if (a.alive) {
                set.drifts[ray] = half_way(a.ray, middle, 1);
            } else if (b.alive) {
                set.drifts[ray] = half_way(middle, b.ray, 1);
            } else {
                account.unknown += 1;
            }
        }
    }
    for (std::uint32_t beam = 0; beam < set.beams.size(); ++beam) {
        if (!kept[beam]) continue;
        VertexRay sum = none;
        float count = 0;
        for (const std::uint32_t ray : set.beams[beam].corners) {
            if (ray == Beam::none || !known[ray]) continue;
            sum.position += set.drifts[ray].position;
            sum.direction += set.drifts[ray].direction;
            ++count;
        }
        if (count == 0) continue;
        for (const std::uint32_t ray : set.beams[beam].corners)
            if (ray != Beam::none && asked[ray] && !known[ray]) {
                set.drifts[ray] = half_way(none, sum, 1 / count);
                asked[ray] = false;  // it is the first beam's that knows
            }
    }
    return account;
}

}  // namespace caustics
