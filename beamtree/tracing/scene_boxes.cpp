#include "beamtree/tracing/scene_boxes.h"

#include <algorithm>

namespace caustics::beamtree {

SceneBoxes scene_boxes(const Scene& scene) {
    SceneBoxes boxes;
    boxes.diameter = scene.diameter();
    for (const std::uint32_t caster : scene.casters())
        boxes.casters.push_back(bounds(scene.shapes()[caster]));
    for (const Shape& shape : scene.shapes())
        if (is_receiver(shape.bsdf)) boxes.receivers.push_back(bounds(shape));
    return boxes;
}

// All that beams light is a mean of places on their rays: where these all lie off one side of a box and none comes
// back, so does it.
bool may_meet_receiver(const SceneBoxes& boxes, const BeamSet& set, const Beam& beam, float margin,
                       bool is_curved) {
    Box places;
    Box directions;
    for (const std::uint32_t corner : beam.corners) {
        if (corner == Beam::none) continue;
        for (const double place : set.places()) {
            const VertexRay ray = set.ray(corner, place);
            places.extend(ray.position);
            directions.extend(ray.direction);
        }
    }
    if (is_curved) {
        // The middle's ray is off the corners' by second order, which is little where these part little.
        const Vec3 parted = directions.sizes().norm() / 2 * directions.sizes();
        directions = Box(directions.min() - parted, directions.max() + parted);
    }
    const Vec3 room = Vec3::Constant(margin);
    return std::ranges::any_of(boxes.receivers, [&](const Box& box) {
        const auto passes_above =
            (places.min() - room).array() > box.max().array() && directions.min().array() >= 0;
        const auto passes_below =
            (places.max() + room).array() < box.min().array() && directions.max().array() <= 0;
        return !(passes_above || passes_below).any();
    });
}

}  // namespace caustics::beamtree
