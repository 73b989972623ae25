#include "core/intersector.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/exact_shape.h"
#include "core/parallel.h"

namespace caustics {
namespace {

void throw_embree_error(void*, RTCError code, const char* text) {
    throw std::runtime_error("Embree: " + std::string(text) + " (error " +
                             std::to_string(static_cast<int>(code)) + ")");
}

// An exact shape with its world -> local map, as Embree's user geometry sees it.
struct ExactGeometry {
    const Shape* shape = nullptr;
    Transform to_local = Transform::Identity();

    std::optional<ExactHit> intersect(const Vec3& origin, const Vec3& direction, float t_min,
                                      float t_max) const {
        const Vec3d o = to_local * origin.cast<double>();
        const Vec3d d = to_local.linear() * direction.cast<double>();
        return intersect_exact(*shape, o, d, static_cast<double>(t_min),
                               static_cast<double>(t_max));
    }
};

void exact_bounds(const RTCBoundsFunctionArguments* args) {
    const auto* geometry = static_cast<const ExactGeometry*>(args->geometryUserPtr);
    const Box box = bounds(*geometry->shape);
    // Outwards by more than float rounding, so that the exact shape lies inside.
    const float pad = 1e-5F * box.max().cwiseAbs().cwiseMax(box.min().cwiseAbs()).maxCoeff();
    const Vec3 low = box.min().array() - pad;
    const Vec3 high = box.max().array() + pad;
    *args->bounds_o = {low.x(), low.y(), low.z(), 0, high.x(), high.y(), high.z(), 0};
}

std::optional<ExactHit> exact_hit(const void* user, const RTCRay& ray) {
    return static_cast<const ExactGeometry*>(user)->intersect(Vec3(ray.org_x, ray.org_y, ray.org_z),
                                                              Vec3(ray.dir_x, ray.dir_y, ray.dir_z),
                                                              ray.tnear, ray.tfar);
}

void exact_intersect(const RTCIntersectFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    auto* rayhit = reinterpret_cast<RTCRayHit*>(args->rayhit);
    const std::optional<ExactHit> hit = exact_hit(args->geometryUserPtr, rayhit->ray);
    if (!hit) return;
    rayhit->ray.tfar = static_cast<float>(hit->distance);
    rayhit->hit.geomID = args->geomID;
    rayhit->hit.primID = args->primID;
}

void exact_occluded(const RTCOccludedFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    auto* ray = reinterpret_cast<RTCRay*>(args->ray);
    if (exact_hit(args->geometryUserPtr, *ray)) ray->tfar = -std::numeric_limits<float>::infinity();
}

RTCGeometry mesh_geometry(RTCDevice device, const TriangleMesh& mesh) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* positions =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.positions.size());
    std::memcpy(positions, mesh.positions.data(), mesh.positions.size() * 3 * sizeof(float));
    void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              3 * sizeof(unsigned), mesh.triangles.size());
    std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(unsigned));
    return geometry;
}

RTCGeometry exact_geometry(RTCDevice device, ExactGeometry& exact) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, &exact);
    rtcSetGeometryBoundsFunction(geometry, exact_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, exact_intersect);
    rtcSetGeometryOccludedFunction(geometry, exact_occluded);
    return geometry;
}

RTCRay to_embree(const Ray& ray) {
    RTCRay r{};
    r.org_x = ray.origin.x();
    r.org_y = ray.origin.y();
    r.org_z = ray.origin.z();
    r.dir_x = ray.direction.x();
    r.dir_y = ray.direction.y();
    r.dir_z = ray.direction.z();
    r.tnear = 0;
    r.tfar = ray.max_distance;
    r.mask = ~0U;
    return r;
}

// The version differences of Embree 3 and 4 live in these two functions alone.
void intersect_scene(RTCScene scene, RTCRayHit& rayhit) {
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene, &rayhit);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &rayhit);
#endif
}

void occlude_scene(RTCScene scene, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(scene, &ray);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
#endif
}

template <typename T>
T interpolate(const std::vector<T>& values, const std::array<std::uint32_t, 3>& triangle, float u,
              float v) {
    return (1 - u - v) * values[triangle[0]] + u * values[triangle[1]] + v * values[triangle[2]];
}

void fill_mesh_point(const TriangleMesh& mesh, std::uint32_t primitive, float u, float v,
                     SurfacePoint& point) {
    const std::array<std::uint32_t, 3>& triangle = mesh.triangles[primitive];
    const Vec3& a = mesh.positions[triangle[0]];
    point.position = interpolate(mesh.positions, triangle, u, v);
    point.geometric_normal =
        (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a).normalized();
    point.shading_normal = point.geometric_normal;
    if (!mesh.normals.empty()) {
        const Vec3 n = interpolate(mesh.normals, triangle, u, v);
        const float length = n.norm();
        if (length > 0) point.shading_normal = n / length;
    }
    point.uv = mesh.uvs.empty() ? Vec2(u, v) : interpolate(mesh.uvs, triangle, u, v);
}

void fill_exact_point(const ExactGeometry& exact, const Vec3d& local, SurfacePoint& point) {
    const Shape& shape = *exact.shape;
    const Vec3d n = exact.to_local.linear().transpose() * exact_normal(shape, local);
    point.position = Vec3d(shape.to_world * local).cast<float>();
    point.geometric_normal = n.normalized().cast<float>();
    if (shape.flip_normals) point.geometric_normal = -point.geometric_normal;
    point.shading_normal = point.geometric_normal;
    point.uv = exact_uv(shape, local);
}

}  // namespace

struct Intersector::Embree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<ExactGeometry> exact;  ///< one a shape, used by exact shapes

    explicit Embree(const std::vector<Shape>& shapes) : exact(shapes.size()) {
        device = rtcNewDevice(nullptr);
        if (device == nullptr) throw std::runtime_error("Embree: no device");
        rtcSetDeviceErrorFunction(device, throw_embree_error, nullptr);
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
        for (std::size_t i = 0; i < shapes.size(); ++i) attach(shapes[i], i);
        run_single_threaded([this] { rtcCommitScene(scene); });
    }
    ~Embree() {
        if (scene != nullptr) rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    void attach(const Shape& shape, std::size_t index) {
        exact[index] = {&shape, shape.to_world.inverse()};
        RTCGeometry geometry = shape.primitive == Primitive::mesh
                                   ? mesh_geometry(device, shape.mesh)
                                   : exact_geometry(device, exact[index]);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(index));
        rtcReleaseGeometry(geometry);
    }
};

Intersector::Intersector(const std::vector<Shape>& shapes, const std::vector<float>& offsets)
    : shapes_(shapes), offsets_(offsets), embree_(std::make_unique<Embree>(shapes)) {}

Intersector::~Intersector() = default;

std::optional<SurfacePoint> Intersector::intersect(const Ray& ray) const {
    RTCRayHit rayhit{};
    rayhit.ray = to_embree(ray);
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect_scene(embree_->scene, rayhit);
    const unsigned index = rayhit.hit.geomID;
    if (index == RTC_INVALID_GEOMETRY_ID) return {};

    SurfacePoint point;
    point.shape = index;
    point.distance = rayhit.ray.tfar;
    point.offset = offsets_[index];
    if (shapes_[index].primitive == Primitive::mesh) {
        fill_mesh_point(shapes_[index].mesh, rayhit.hit.primID, rayhit.hit.u, rayhit.hit.v, point);
        return point;
    }
    // Embree kept the rounded distance only: solve again for the point in double.
    const ExactGeometry& exact = embree_->exact[index];
    const auto hit = exact.intersect(ray.origin, ray.direction, 0, ray.max_distance);
    if (!hit) throw std::logic_error("an exact shape was hit once and missed once");
    fill_exact_point(exact, hit->local, point);
    return point;
}

bool Intersector::occluded(const Ray& ray) const {
    RTCRay shadow = to_embree(ray);
    occlude_scene(embree_->scene, shadow);
    return shadow.tfar < 0;
}

}  // namespace caustics
