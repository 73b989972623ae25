#pragma once

#include <optional>

#include "core/math/vec.h"

namespace caustics {

/// Pinhole of Mitsuba's `perspective`: looks along +z, +y up, +x to the left of the picture.
struct Camera {
    enum class FovAxis { x, y, diagonal, smaller, larger };

    Transform to_world = Transform::Identity();
    double fov_degrees = 50;
    FovAxis fov_axis = FovAxis::x;
    int width = 768;
    int height = 576;

    Vec3 position() const;
    /// World direction through the film point (x, y) in pixels, of any length.
    Vec3d towards(double x, double y) const;
    /// Unit world direction through the film point (x, y) in pixels, (0, 0) the top left corner.
    Vec3 direction(double x, double y) const;

    /// Area of a pixel on the image plane at distance 1.
    double pixel_area() const;

    /// Tangents of half the field of view along the film's width and height.
    Vec2d half_extent() const;
};

/// The way back, from points of the scene to a camera's film; made once for many points.
class FilmProjection {
public:
    struct Seen {
        double x, y;       ///< film point [pixels]
        double cos_theta;  ///< between the optical axis and the ray
        double distance;   ///< [m]
    };

    explicit FilmProjection(const Camera& camera);

    /// The film point that sees `p`; empty behind the camera or outside the film.
    std::optional<Seen> project(const Vec3& p) const;
    double pixel_area() const { return pixel_area_; }  ///< Camera::pixel_area

private:
    Transform to_local_;
    Vec3d eye_;
    Vec2d half_extent_;
    double pixel_area_;
    int width_;
    int height_;
};

}  // namespace caustics
