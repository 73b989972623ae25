#pragma once

#include <stdexcept>
#include <string>

#include "experiments/gallery/gallery.h"

namespace caustics::experiments {

/// A scene of the gallery.
inline GalleryScene scene_named(const std::string& name) {
    for (GalleryScene& scene : gallery())
        if (scene.name == name) return scene;
    throw std::logic_error("no such scene in the gallery: " + name);
}

}  // namespace caustics::experiments
