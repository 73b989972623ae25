#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/caustic_estimator.h"
#include "core/geometry/shape.h"
#include "core/math/rng.h"
#include "core/math/sampling.h"
#include "core/scene/scene.h"

namespace caustics {

/// Round each caster of the scene.
std::vector<BoundingSphere> caster_bounds(const Scene& scene);

/// Directions from a receiver point: half from its BSDF, half uniform in the cone of a caster's
/// bounding sphere, combined by the balance heuristic of one sample (Veach & Guibas 1995).
class DirectionMixture {
public:
    /// `point` outlives this.
    DirectionMixture(std::span<const BoundingSphere> casters, const ReceiverPoint& point);

    /// Unit, or none when the sample falls below the surface.
    std::optional<Vec3> sample(Rng& rng) const;
    /// Of sample() [1/sr].
    float pdf_w(const Vec3& wi) const;

private:
    const Bsdf& bsdf() const { return *point_.bsdf; }

    const ReceiverPoint& point_;
    std::vector<DirectionCone> cones_;
};

}  // namespace caustics
