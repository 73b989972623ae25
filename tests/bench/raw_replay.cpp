#include "tests/bench/raw_replay.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "core/base/parallel.h"

namespace caustics::bench {

namespace {

RTCRay to_embree(const Ray& ray) {
    return {ray.origin.x(),
            ray.origin.y(),
            ray.origin.z(),
            0,
            ray.direction.x(),
            ray.direction.y(),
            ray.direction.z(),
            0,
            ray.max_distance,
            ~0U,
            0,
            0};
}

void attach(RTCDevice device, RTCScene scene, const TriangleMesh& mesh) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* const positions =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.positions.size());
    std::memcpy(positions, mesh.positions.data(), mesh.positions.size() * 3 * sizeof(float));
    void* const triangles =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size());
    std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(unsigned));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

bool trace(RTCScene scene, RTCRayHit& rayhit) {
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene, &rayhit);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &rayhit);
#endif
    return rayhit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

}  // namespace

struct RawReplay::Embree {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    std::vector<RTCRay> rays;

    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
};

RawReplay::RawReplay(const Scene& scene, const std::vector<Ray>& rays)
    : embree_(std::make_unique<Embree>()) {
    rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(embree_->scene, RTC_BUILD_QUALITY_MEDIUM);
    for (const Shape& shape : scene.shapes()) {
        if (shape.primitive != Primitive::mesh)
            throw std::logic_error("a raw replay knows meshes only, not " + shape.name);
        attach(embree_->device, embree_->scene, shape.mesh);
    }
    run_single_threaded([this] { rtcCommitScene(embree_->scene); });
    for (const Ray& ray : rays) embree_->rays.push_back(to_embree(ray));
}

RawReplay::~RawReplay() = default;

std::size_t RawReplay::run(int threads) const {
    const std::vector<RTCRay>& rays = embree_->rays;
    const auto runs = static_cast<std::size_t>(threads);
    std::vector<std::size_t> hits(runs, 0);
    parallel_for(threads, runs, [&](std::size_t i, std::size_t) {
        std::size_t own = 0;
        for (std::size_t r = rays.size() * i / runs; r < rays.size() * (i + 1) / runs; ++r) {
            RTCRayHit rayhit;
            rayhit.ray = rays[r];
            own += trace(embree_->scene, rayhit) ? 1 : 0;
        }
        hits[i] = own;
    });
    std::size_t sum = 0;
    for (const std::size_t h : hits) sum += h;
    return sum;
}

}  // namespace caustics::bench
