#include "tests/bench/embree_beams.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/base/parallel.h"

namespace caustics::bench {

namespace {

/// A device and a scene with one geometry.
struct OneGeometry {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);

    OneGeometry() { rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM); }
    ~OneGeometry() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    OneGeometry(const OneGeometry&) = delete;
    OneGeometry& operator=(const OneGeometry&) = delete;

    void attach(RTCGeometry geometry) const {
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
    }
};

void bound(const RTCBoundsFunctionArguments* arguments) {
    const auto& triangle =
        static_cast<const SlicedPeer*>(arguments->geometryUserPtr)[arguments->primID];
    const auto step = static_cast<float>(arguments->timeStep);
    float low[2];
    float high[2];
    for (int axis = 0; axis < 2; ++axis) {
        low[axis] = std::numeric_limits<float>::infinity();
        high[axis] = -low[axis];
        for (int c = 0; c < 3; ++c) {
            const float at = triangle.corner[c][axis] + step * triangle.growth[c][axis];
            low[axis] = std::min(low[axis], at);
            high[axis] = std::max(high[axis], at);
        }
    }
    RTCBounds& box = *arguments->bounds_o;
    box.lower_x = low[0];
    box.lower_y = low[1];
    box.upper_x = high[0];
    box.upper_y = high[1];
    box.lower_z = box.upper_z = 0;
}

/// What a query carries.
struct Collected {
    const SlicedPeer* triangles;
    float slack;
    std::uint32_t* found;
    std::size_t count;
};

bool collect(RTCPointQueryFunctionArguments* arguments) {
    Collected& to = *static_cast<Collected*>(arguments->userPtr);
    const RTCPointQuery& query = *arguments->query;
    if (may_hold(to.triangles[arguments->primID], query.x, query.y, query.time, to.slack))
        to.found[to.count++] = arguments->primID;
    return false;  // the radius stays
}

}  // namespace

struct EmbreeBeams::Embree : OneGeometry {
    std::vector<SlicedPeer> triangles;
};

EmbreeBeams::EmbreeBeams(const std::vector<SlicedPeer>& triangles)
    : embree_(std::make_unique<Embree>()) {
    embree_->triangles = triangles;
    RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryTimeStepCount(geometry, 2);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(triangles.size()));
    rtcSetGeometryUserData(geometry, embree_->triangles.data());
    rtcSetGeometryBoundsFunction(
        geometry, [](const RTCBoundsFunctionArguments* arguments) { bound(arguments); }, nullptr);
    embree_->attach(geometry);
    run_single_threaded([this] { rtcCommitScene(embree_->scene); });
}

EmbreeBeams::~EmbreeBeams() = default;

std::size_t EmbreeBeams::find(float x, float y, float t, float slack, std::uint32_t* found) const {
    Collected collected{embree_->triangles.data(), slack, found, 0};
    RTCPointQuery query{x, y, 0, t, 1e-6F};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(embree_->scene, &query, &context, collect, &collected);
    return collected.count;
}

struct EmbreeMesh::Embree : OneGeometry {};

EmbreeMesh::EmbreeMesh(const float* positions, std::size_t vertices, const unsigned* triangles,
                       std::size_t count)
    : embree_(std::make_unique<Embree>()) {
    rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                        3 * sizeof(float), vertices),
                positions, 3 * sizeof(float) * vertices);
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                        3 * sizeof(unsigned), count),
                triangles, 3 * sizeof(unsigned) * count);
    embree_->attach(geometry);
}

EmbreeMesh::~EmbreeMesh() = default;

void EmbreeMesh::commit() { rtcCommitScene(embree_->scene); }

}  // namespace caustics::bench
