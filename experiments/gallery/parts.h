#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/gallery/gallery.h"
#include "experiments/gallery/meridian.h"

namespace caustics::experiments::gallery_parts {

Bsdf grey();    ///< diffuse, reflectance 1/2
Bsdf mirror();  ///< perfect, from both sides
Bsdf glass(double ior, double absorption = 0);

/// The parallelogram centre +- u +- v, its front on the side of u x v.
Shape rectangle(const std::string& name, const Vec3d& centre, const Vec3d& u, const Vec3d& v,
                const Bsdf& bsdf);
/// A square across z with half its side; faces up or down.
Shape square(const std::string& name, double z, double half, bool up, const Bsdf& bsdf);
/// A disk across z round the axis, facing down.
Shape disk_facing_down(const std::string& name, double z, double radius, const Bsdf& bsdf);
Shape mesh(const std::string& name, TriangleMesh mesh, const Bsdf& bsdf);

PointLight point_light(const Vec3d& position, double intensity);
DirectionalLight directional_light(const Vec3d& direction, double irradiance);

/// A point of a profile in the plane through the axis, with its normal there.
struct ProfilePoint {
    double radius, z;
    Vec2d normal;  ///< unit; (outwards, up)
};
/// A profile turned round the z axis: `bands` of its parameter in [0, 1], 4 x bands sectors, with
/// exact vertex normals. Triangles face as the normals do. A radius of 0 is an end on the axis.
TriangleMesh turned(const std::function<ProfilePoint(double)>& profile, int bands);
/// Both, one after the other.
TriangleMesh joined(TriangleMesh first, const TriangleMesh& second);

/// `count` points (x, y) of the square |x - centre.x|, |y - centre.y| <= half, spread evenly.
std::vector<Vec2d> spread(int count, const Vec2d& centre, double half);
/// The same by area over the ring between two radii.
std::vector<Vec2d> spread_over_ring(int count, double inner, double outer);

/// At how many points most scenes are asked.
inline constexpr int asked = 60;
/// So many points at the height z, on a ring of a receiver that faces up or down.
std::vector<KnownPoint> known_on_ring(const Meridian& light, double z, bool up, double inner,
                                      double outer);

/// The usual series. `radius`: discs of `lighttrace`, small against what the light varies over.
Series light_trace(double radius, double tolerance, std::uint64_t paths = 100'000);
Series path_trace(double tolerance, int paths);
/// The first of three efforts has so many photons and nearest ones.
Series photon_map(double tolerance, const std::string& more = "", int photons = 10'000,
                  int nearest = 20);
/// Beam tree and caustic polygons over meshes of `coarsest` bands or cells, twice and four times as many.
Series beam_tree(double factor, double tolerance, const std::string& more = "", int coarsest = 16);
Series caustic_polygons(double factor, double tolerance, const std::string& more = "",
                        int coarsest = 16);
/// All that serve point and directional lights on diffuse receivers.
std::vector<Series> usual_series(double radius, double beam_factor, double beam_tolerance,
                                 int coarsest = 16);

}  // namespace caustics::experiments::gallery_parts
