#pragma once

#include <string>
#include <vector>

#include "core/caustic_estimator.h"
#include "core/scene/scene.h"

namespace caustics::support {

/// Bsdfs by one word.
Bsdf diffuse(float reflectance, bool twosided = false);
Bsdf schlick(float reflectance, float alpha);
Bsdf phong(float diffuse, float specular, float exponent,
           Phong::Model model = Phong::Model::normalised);
Bsdf mirror(float reflectance = 1);
Bsdf glass(float int_ior, float ext_ior = 1, const Spectrum& absorption = black(),
           const Spectrum& ext_absorption = black());

/// The parallelogram centre +- u +- v; its front is on the side of u x v.
Shape rectangle(const std::string& name, const Vec3d& centre, const Vec3d& half_u,
                const Vec3d& half_v, const Bsdf& bsdf);
Shape sphere(const std::string& name, const Vec3d& centre, double radius, const Bsdf& bsdf);
/// `mesh` in a local frame -> world frame.
Shape mesh(const std::string& name, TriangleMesh mesh, const Transform& to_world, const Bsdf& bsdf);
/// The same without vertex normals: shaded flat.
TriangleMesh flat(TriangleMesh mesh);
/// The sum of its triangles.
double mesh_area(const TriangleMesh& mesh);

/// A horizontal square at height z, facing up or down.
Shape horizontal(const std::string& name, double z, double half, bool up, const Bsdf& bsdf);

/// A sphere that faces inwards, to catch everything that leaves the middle.
Shape enclosure(double radius, const Bsdf& bsdf);

/// Six squares round the cube [-half, half]^3 that face inwards and emit `radiance`.
std::vector<Shape> emitting_room(double half, float radiance, const Bsdf& bsdf);

PointLight point_light(const Vec3d& position, float intensity);
DirectionalLight directional_light(const Vec3d& direction, float irradiance);

/// A camera of Mitsuba's `look_at` convention: +z to the target, +x to the left.
Camera camera(const Vec3d& origin, const Vec3d& target, const Vec3d& up, double fov_degrees,
              int width, int height);

/// An offset (SurfacePoint::offset) that holds all over a shape, for a point that no ray has found.
float surface_offset(const Scene& scene, std::size_t shape, const Vec3& position,
                     const Vec3& normal);
/// A receiver point on a flat shape of the scene, seen along its normal.
ReceiverPoint probe(const Scene& scene, std::size_t shape, const Vec3d& position,
                    const Vec3d& normal, std::uint64_t id, float radius = 0);

/// What `irradiance` answers at the points, with a context of its own.
std::vector<Estimate> irradiance(const PointEstimator& estimator,
                                 const std::vector<ReceiverPoint>& points);

}  // namespace caustics::support
