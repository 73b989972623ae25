#include "tests/support/build_scene.h"

#include <memory>
#include <utility>

#include "core/geometry/surface_offset.h"

namespace caustics::support {

Bsdf diffuse(float reflectance, bool twosided) {
    return {Diffuse{Spectrum(Spectrum::Constant(reflectance))}, twosided};
}

Bsdf schlick(float reflectance, float alpha) {
    return {Schlick{Spectrum(Spectrum::Constant(reflectance)), alpha}, false};
}

Bsdf phong(float diffuse, float specular, float exponent, Phong::Model model) {
    return {Phong{.diffuse_reflectance = Spectrum(Spectrum::Constant(diffuse)),
                  .specular_reflectance = Spectrum(Spectrum::Constant(specular)),
                  .exponent = exponent,
                  .model = model,
                  .lobe_share = specular / (diffuse + specular)},
            false};
}

Bsdf mirror(float reflectance) { return {Conductor{Spectrum::Constant(reflectance)}, true}; }

Bsdf glass(float int_ior, float ext_ior, const Spectrum& absorption,
           const Spectrum& ext_absorption) {
    Dielectric dielectric;
    dielectric.int_ior = int_ior;
    dielectric.ext_ior = ext_ior;
    dielectric.absorption = absorption;
    dielectric.ext_absorption = ext_absorption;
    return {dielectric, false};
}

Shape rectangle(const std::string& name, const Vec3d& centre, const Vec3d& half_u,
                const Vec3d& half_v, const Bsdf& bsdf) {
    Shape shape;
    shape.name = name;
    shape.primitive = Primitive::rectangle;
    shape.to_world.linear().col(0) = half_u;
    shape.to_world.linear().col(1) = half_v;
    shape.to_world.linear().col(2) = half_u.cross(half_v).normalized();
    shape.to_world.translation() = centre;
    shape.bsdf = bsdf;
    return shape;
}

Shape sphere(const std::string& name, const Vec3d& centre, double radius, const Bsdf& bsdf) {
    Shape shape;
    shape.name = name;
    shape.primitive = Primitive::sphere;
    shape.to_world = Eigen::Translation3d(centre) * Eigen::Scaling(radius);
    shape.bsdf = bsdf;
    return shape;
}

Shape mesh(const std::string& name, TriangleMesh mesh, const Transform& to_world,
           const Bsdf& bsdf) {
    Shape shape;
    shape.name = name;
    shape.primitive = Primitive::mesh;
    transform(mesh, to_world);
    shape.mesh = std::move(mesh);
    shape.bsdf = bsdf;
    return shape;
}

TriangleMesh flat(TriangleMesh mesh) {
    mesh.normals.clear();
    return mesh;
}

double mesh_area(const TriangleMesh& mesh) {
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3d p = mesh.positions[a].cast<double>();
        const Vec3d e1 = mesh.positions[b].cast<double>() - p;
        const Vec3d e2 = mesh.positions[c].cast<double>() - p;
        area += e1.cross(e2).norm() / 2;
    }
    return area;
}

Shape horizontal(const std::string& name, double z, double half, bool up, const Bsdf& bsdf) {
    return rectangle(name, {0, 0, z}, {half, 0, 0}, {0, up ? half : -half, 0}, bsdf);
}

Shape enclosure(double radius, const Bsdf& bsdf) {
    Shape shape = sphere("enclosure", Vec3d::Zero(), radius, bsdf);
    shape.flip_normals = true;
    return shape;
}

std::vector<Shape> emitting_room(double half, float radiance, const Bsdf& bsdf) {
    std::vector<Shape> walls;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const Vec3d normal = -side * Vec3d::Unit(axis);
            const Vec3d u = Vec3d::Unit((axis + 1) % 3);
            const Vec3d v = normal.cross(u);
            walls.push_back(rectangle("wall" + std::to_string(walls.size()),
                                      side * half * Vec3d::Unit(axis), half * u, half * v, bsdf));
            walls.back().radiance = Spectrum(Spectrum::Constant(radiance));
        }
    return walls;
}

PointLight point_light(const Vec3d& position, float intensity) {
    return {position.cast<float>(), Spectrum::Constant(intensity)};
}

DirectionalLight directional_light(const Vec3d& direction, float irradiance) {
    return {direction.normalized().cast<float>(), Spectrum::Constant(irradiance)};
}

Camera camera(const Vec3d& origin, const Vec3d& target, const Vec3d& up, double fov_degrees,
              int width, int height) {
    const Vec3d forward = (target - origin).normalized();
    const Vec3d left = up.cross(forward).normalized();
    Camera camera;
    camera.to_world.linear().col(0) = left;
    camera.to_world.linear().col(1) = forward.cross(left);
    camera.to_world.linear().col(2) = forward;
    camera.to_world.translation() = origin;
    camera.fov_degrees = fov_degrees;
    camera.width = width;
    camera.height = height;
    return camera;
}

float surface_offset(const Scene& scene, std::size_t shape, const Vec3& position,
                     const Vec3& normal) {
    const Box box = bounds(scene.shapes()[shape]);
    return triangle_offset(position, normal, box.min(), box.max(), box.center());
}

ReceiverPoint probe(const Scene& scene, std::size_t shape, const Vec3d& position,
                    const Vec3d& normal, std::uint64_t id, float radius) {
    ReceiverPoint point;
    point.position = position.cast<float>();
    point.geometric_normal = point.shading_normal = point.wo = normal.cast<float>();
    point.uv = Vec2::Zero();
    point.offset = surface_offset(scene, shape, point.position, point.geometric_normal);
    point.bsdf = &scene.shapes()[shape].bsdf;
    point.shape = static_cast<std::uint32_t>(shape);
    point.id = id;
    point.radius = radius;
    return point;
}

std::vector<Estimate> irradiance(const PointEstimator& estimator,
                                 const std::vector<ReceiverPoint>& points) {
    std::vector<Estimate> out(points.size());
    const std::unique_ptr<QueryContext> context = estimator.make_context();
    estimator.irradiance(points, out, *context);
    return out;
}

}  // namespace caustics::support
