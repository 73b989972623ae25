#pragma once

namespace caustics::fuzz {

/// A scene that is read and built in no time: a mirror ball over a floor.
inline constexpr const char* small_scene = R"({
 "camera": {"type": "perspective", "fov": 40,
   "to_world": [{"look_at": {"origin": [0, -4, 2], "target": [0, 0, 0], "up": [0, 0, 1]}}],
   "film": {"type": "hdrfilm", "width": 4, "height": 4}, "sampler": {"type": "independent", "sample_count": 1}},
 "lamp": {"type": "point", "position": [1, 0, 3], "intensity": 10},
 "floor": {"type": "rectangle", "to_world": [{"scale": 2}, {"translate": [0, 0, -1]}],
   "bsdf": {"type": "diffuse", "reflectance": 0.5}},
 "ball": {"type": "sphere", "radius": 0.5, "bsdf": {"type": "conductor", "material": "none"}}})";

}  // namespace caustics::fuzz
