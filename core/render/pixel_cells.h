#pragma once

#include <optional>

#include "core/receiver_point.h"
#include "core/scene/camera.h"

namespace caustics {

/// A rectangle of the film [pixels] as the camera sees it on the tangent plane of a receiver point. Empty where the
/// camera's rays pass that plane: a horizon runs through the rectangle.
std::optional<PixelCell> pixel_cell(const Camera& camera, const Eigen::AlignedBox2d& film,
                                    const ReceiverPoint& point);

}  // namespace caustics
