#pragma once

#include <optional>

#include "core/receiver_point.h"
#include "core/scene/camera.h"
#include "core/scene/scene.h"

namespace caustics {

/// A rectangle of the film [pixels] as the camera sees it on the tangent plane of a receiver point. Empty where the
/// camera's rays pass that plane: a horizon runs through the rectangle.
std::optional<PixelCell> pixel_cell(const Camera& camera, const Eigen::AlignedBox2d& film,
                                    const ReceiverPoint& point);

/// Whether a receiver goes on up to the cell's corners: a surface that faces as the point's does lies within a tenth of the
/// cell's radius of each, whatever may stand before it. The mean over a cell that reaches beyond its receiver would be too
/// small: samples beyond the edge see something else, so that what is missing there would be missing twice.
bool lies_on_receiver(const Scene& scene, const ReceiverPoint& point, const PixelCell& cell);

}  // namespace caustics
