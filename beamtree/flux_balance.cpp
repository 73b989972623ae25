#include "beamtree/flux_balance.h"

#include <algorithm>
#include <optional>

#include "beamtree/caster_mesh.h"
#include "core/parallel.h"

namespace caustics {

namespace {

FluxBalance balance_of(const Scene& scene, const BeamSet& set, const Beam& beam) {
    const auto [a, b, c] = set.triangle(beam, 0);
    const Vec3 normal = triangle_normal(a->position, b->position, c->position);
    const SegmentEnd middle{(a->position + b->position + c->position) / 3, normal, beam.offset};
    if (!sees(scene, middle, set.light)) return {};
    FluxBalance balance{static_cast<double>(beam.flux.mean()), 0};
    const Vec3 direction = (a->direction + b->direction + c->direction).normalized();
    const std::optional<SurfacePoint> hit = scene.intersect(spawn_ray(middle, direction));
    if (hit && is_caster(scene.shape_at(*hit).bsdf)) balance.to_casters = balance.lit;
    return balance;
}

}  // namespace

FluxBalance flux_balance(const Scene& scene, const std::vector<BeamSet>& sets,
                         const RunOptions& options) {
    constexpr std::size_t chunk = 1024;
    FluxBalance sum;
    for (const BeamSet& set : sets) {
        std::vector<FluxBalance> parts((set.beams.size() + chunk - 1) / chunk);
        parallel_for(options.threads, parts.size(), [&](std::size_t part, std::size_t) {
            const std::size_t end = std::min(set.beams.size(), (part + 1) * chunk);
            for (std::size_t i = part * chunk; i < end; ++i) {
                const FluxBalance one = balance_of(scene, set, set.beams[i]);
                parts[part].lit += one.lit;
                parts[part].to_casters += one.to_casters;
            }
        });
        for (const FluxBalance& part : parts) {
            sum.lit += part.lit;
            sum.to_casters += part.to_casters;
        }
    }
    return sum;
}

}  // namespace caustics
