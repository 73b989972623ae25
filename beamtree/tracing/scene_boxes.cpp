#include "beamtree/tracing/scene_boxes.h"

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

}  // namespace caustics::beamtree
