#include "core/scene/intersector.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <variant>

#include "core/base/interrupt.h"
#include "core/base/parallel.h"
#include "core/scene/placed_surfaces.h"

namespace caustics {
namespace {

// throw_if_interrupted() reports an interrupted commit after it.
void throw_embree_error(void*, RTCError code, const char* text) {
    if (code == RTC_ERROR_CANCELLED) return;
    throw std::runtime_error("Embree: " + std::string(text) + " (error " +
                             std::to_string(static_cast<int>(code)) + ")");
}

[[noreturn]] void throw_no_device() {
    const RTCError code = rtcGetDeviceError(nullptr);
    if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw std::runtime_error(
        code == RTC_ERROR_UNSUPPORTED_CPU
            ? "Embree does not run on this processor: it needs SSE2 or Neon at least"
            : "Embree cannot start (error " + std::to_string(static_cast<int>(code)) +
                  "): memory or threads may be limited (ulimit -v, -u)");
}

void exact_bounds(const RTCBoundsFunctionArguments* args) {
    const auto* geometry = static_cast<const PlacedExact*>(args->geometryUserPtr);
    const Box box = bounds(geometry->shape());
    // Outwards by more than float rounding, so that the exact shape lies inside.
    const float pad = 1e-5F * box.max().cwiseAbs().cwiseMax(box.min().cwiseAbs()).maxCoeff();
    const Vec3 low = box.min().array() - pad;
    const Vec3 high = box.max().array() + pad;
    *args->bounds_o = {low.x(), low.y(), low.z(), 0, high.x(), high.y(), high.z(), 0};
}

std::optional<ExactHit> exact_hit(const void* user, RTCRayN* rays, unsigned n, unsigned i) {
    const Vec3 origin(RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i),
                      RTCRayN_org_z(rays, n, i));
    const Vec3 direction(RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i),
                         RTCRayN_dir_z(rays, n, i));
    return static_cast<const PlacedExact*>(user)->intersect(
        origin, direction, RTCRayN_tnear(rays, n, i), RTCRayN_tfar(rays, n, i));
}

// What Embree hands on to the functions of exact shapes; versions 3 and 4 differ here and below.
#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
#else
using EmbreeContext = RTCIntersectContext;
#endif
struct Query {
    EmbreeContext context;  // first, so that a pointer to it is one to the query
    std::array<ExactHit, most_rays_together> exact;  // of the exact shape hit last, by ray's id
};

void exact_intersect(const RTCIntersectFunctionNArguments* args) {
    const unsigned n = args->N;
    RTCRayN* const rays = RTCRayHitN_RayN(args->rayhit, n);
    RTCHitN* const hits = RTCRayHitN_HitN(args->rayhit, n);
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] == 0) continue;
        const std::optional<ExactHit> hit = exact_hit(args->geometryUserPtr, rays, n, i);
        if (!hit) continue;
        RTCRayN_tfar(rays, n, i) = static_cast<float>(hit->distance);
        RTCHitN_geomID(hits, n, i) = args->geomID;
        RTCHitN_primID(hits, n, i) = args->primID;
        // Embree keeps the rounded distance only. Each hit is nearer than all before it, so that
        // the last one stays.
        reinterpret_cast<Query*>(args->context)->exact[RTCRayN_id(rays, n, i)] = *hit;
    }
}

void exact_occluded(const RTCOccludedFunctionNArguments* args) {
    for (unsigned i = 0; i < args->N; ++i)
        if (args->valid[i] != 0 && exact_hit(args->geometryUserPtr, args->ray, args->N, i))
            RTCRayN_tfar(args->ray, args->N, i) = -std::numeric_limits<float>::infinity();
}

RTCGeometry mesh_geometry(RTCDevice device, const PlacedMesh& mesh) {
    const auto& vertices = mesh.vertices();
    const auto& triangles = mesh.mesh().triangles;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               vertices.data(), 0, sizeof(PlacedMesh::Vertex), vertices.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               triangles.data(), 0, 3 * sizeof(std::uint32_t), triangles.size());
    return geometry;
}

RTCGeometry exact_geometry(RTCDevice device, PlacedExact& exact) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, &exact);
    rtcSetGeometryBoundsFunction(geometry, exact_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, exact_intersect);
    rtcSetGeometryOccludedFunction(geometry, exact_occluded);
    return geometry;
}

// Embree reads the ray by 16 bytes at a time: written the same way, its loads need not wait for
// single stores to reach the cache.
void write_ray(const Ray& ray, RTCRay& out) {
    const Vec3& o = ray.origin;
    const Vec3& d = ray.direction;
#ifdef __SSE2__
    float* const to = reinterpret_cast<float*>(&out);
    const __m128i all = _mm_set_epi32(0, 0, -1, 0);
    _mm_store_ps(to, _mm_set_ps(0, o.z(), o.y(), o.x()));
    _mm_store_ps(to + 4, _mm_set_ps(0, d.z(), d.y(), d.x()));
    _mm_store_ps(to + 8, _mm_or_ps(_mm_set_ss(ray.max_distance), _mm_castsi128_ps(all)));
#else
    out = {o.x(), o.y(), o.z(), 0, d.x(), d.y(), d.z(), 0, ray.max_distance, ~0U, 0, 0};
#endif
}
static_assert(offsetof(RTCRay, dir_x) == 16 && offsetof(RTCRay, tfar) == 32 &&
              offsetof(RTCRay, mask) == 36 && sizeof(RTCRay) == 48);

void intersect_scene(RTCScene scene, RTCRayHit& rayhit, Query& query) {
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&query.context);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &query.context;
    rtcIntersect1(scene, &rayhit, &arguments);
#else
    rtcInitIntersectContext(&query.context);
    rtcIntersect1(scene, &query.context, &rayhit);
#endif
}

using Packet = RTCRayHit16;
static_assert(most_rays_together == 16);

void intersect_packet(RTCScene scene, const int* valid, Packet& packet, Query& query) {
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&query.context);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &query.context;
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect16(valid, scene, &packet, &arguments);
#else
    rtcInitIntersectContext(&query.context);
    query.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid, scene, &query.context, &packet);
#endif
}

void write_ray(const Ray& ray, unsigned i, Packet& packet) {
    packet.ray.org_x[i] = ray.origin.x();
    packet.ray.org_y[i] = ray.origin.y();
    packet.ray.org_z[i] = ray.origin.z();
    packet.ray.tnear[i] = 0;
    packet.ray.dir_x[i] = ray.direction.x();
    packet.ray.dir_y[i] = ray.direction.y();
    packet.ray.dir_z[i] = ray.direction.z();
    packet.ray.time[i] = 0;
    packet.ray.tfar[i] = ray.max_distance;
    packet.ray.mask[i] = ~0U;
    packet.ray.id[i] = i;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
}

// Where Embree has no packets of this width it cuts them up and takes for valid what is not empty, whatever `valid` says;
// what no one has written may even abort it.
void write_no_ray(unsigned i, Packet& packet) {
    write_ray(Ray{}, i, packet);
    packet.ray.tnear[i] = 1;
    packet.ray.tfar[i] = 0;
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

}  // namespace

struct Intersector::Embree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<std::variant<PlacedMesh, PlacedExact>> geometries;  ///< of the shapes

    explicit Embree(std::size_t shapes) {
        geometries.reserve(shapes);  // so that none moves
        device = rtcNewDevice(nullptr);
        if (device == nullptr) throw_no_device();
        rtcSetDeviceErrorFunction(device, throw_embree_error, nullptr);
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    }
    ~Embree() {
        if (scene != nullptr) rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    void build(const std::vector<Shape>& shapes) {
        for (std::size_t i = 0; i < shapes.size(); ++i) attach(shapes[i], i);
        rtcSetSceneProgressMonitorFunction(
            scene, [](void*, double) { return !interrupt_requested(); }, nullptr);
        run_single_threaded([this] { rtcCommitScene(scene); });
        throw_if_interrupted();
    }

    void attach(const Shape& shape, std::size_t index) {
        RTCGeometry geometry = nullptr;
        if (shape.primitive == Primitive::mesh) {
            geometries.emplace_back(PlacedMesh(shape));
            geometry = mesh_geometry(device, std::get<PlacedMesh>(geometries.back()));
        } else {
            geometries.emplace_back(PlacedExact(shape));
            geometry = exact_geometry(device, std::get<PlacedExact>(geometries.back()));
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(index));
        rtcReleaseGeometry(geometry);
    }
};

Intersector::Intersector(const std::vector<Shape>& shapes)
    : embree_(std::make_unique<Embree>(shapes.size())) {
    embree_->build(shapes);
}

Intersector::~Intersector() = default;

// What Embree says of a ray's end.
struct Intersector::Arrival {
    unsigned geometry;
    unsigned primitive;
    float u, v;
    float distance;
    const ExactHit& exact;
};

void Intersector::fill(const Arrival& arrival, SurfacePoint& point) const {
    point.shape = arrival.geometry;
    point.distance = arrival.distance;
    const auto& geometry = embree_->geometries[arrival.geometry];
    point.triangle = 0;
    if (const auto* mesh = std::get_if<PlacedMesh>(&geometry)) {
        point.triangle = arrival.primitive;
        mesh->fill(arrival.primitive, arrival.u, arrival.v, point);
    } else {
        std::get<PlacedExact>(geometry).fill(arrival.exact.local, point);
    }
}

std::optional<SurfacePoint> Intersector::intersect(const Ray& ray) const {
    RTCRayHit rayhit;
    write_ray(ray, rayhit.ray);
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    Query query;
    intersect_scene(embree_->scene, rayhit, query);
    const RTCHit& hit = rayhit.hit;
    if (hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    std::optional<SurfacePoint> found(std::in_place);
    fill({hit.geomID, hit.primID, hit.u, hit.v, rayhit.ray.tfar, query.exact[0]}, *found);
    return found;
}

void Intersector::intersect_together(std::span<const Ray> rays,
                                     std::span<std::optional<SurfacePoint>> hits) const {
    Packet packet;
    alignas(64) std::array<int, most_rays_together> valid{};
    for (unsigned i = 0; i < rays.size(); ++i) {
        valid[i] = -1;
        write_ray(rays[i], i, packet);
    }
    for (auto i = static_cast<unsigned>(rays.size()); i < most_rays_together; ++i)
        write_no_ray(i, packet);
    Query query;
    intersect_packet(embree_->scene, valid.data(), packet, query);
    const RTCHit16& hit = packet.hit;
    for (unsigned i = 0; i < rays.size(); ++i) {
        hits[i].reset();
        if (hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
        fill({hit.geomID[i], hit.primID[i], hit.u[i], hit.v[i], packet.ray.tfar[i], query.exact[i]},
             hits[i].emplace());
    }
}

bool Intersector::occluded(const Ray& ray) const {
    RTCRay shadow;
    write_ray(ray, shadow);
    occlude_scene(embree_->scene, shadow);
    return shadow.tfar < 0;
}

}  // namespace caustics
