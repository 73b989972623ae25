#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "tests/bench/beam_scan_peer.h"

namespace caustics::bench {

/// The same triangles in Embree: a user geometry of flat boxes with two time steps, which are the
/// planes, asked by rtcPointQuery at the time t. Built with one thread.
class EmbreeBeams {
public:
    explicit EmbreeBeams(const std::vector<SlicedPeer>& triangles);
    ~EmbreeBeams();
    EmbreeBeams(const EmbreeBeams&) = delete;
    EmbreeBeams& operator=(const EmbreeBeams&) = delete;

    /// Numbers of the triangles that may hold the point, as BeamScan::find.
    std::size_t find(float x, float y, float t, float slack, std::uint32_t* found) const;

private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
};

/// rtcCommitScene of one mesh, by one thread, as core/scene/intersector builds its scenes.
class EmbreeMesh {
public:
    EmbreeMesh(const float* positions, std::size_t vertices, const unsigned* triangles,
               std::size_t count);
    ~EmbreeMesh();
    EmbreeMesh(const EmbreeMesh&) = delete;
    EmbreeMesh& operator=(const EmbreeMesh&) = delete;

    void commit();

private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
};

}  // namespace caustics::bench
