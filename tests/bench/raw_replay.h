#pragma once

#include <memory>
#include <vector>

#include "core/scene/scene.h"

namespace caustics::bench {

/// Recorded rays traced again through nothing but rtcIntersect1, in a robust scene of the same
/// meshes: what Embree alone takes for them.
class RawReplay {
public:
    /// All shapes must be meshes.
    RawReplay(const Scene& scene, const std::vector<Ray>& rays);
    ~RawReplay();
    RawReplay(const RawReplay&) = delete;
    RawReplay& operator=(const RawReplay&) = delete;

    /// Traces all rays, by equal runs of consecutive rays for each thread; returns how many hit.
    std::size_t run(int threads) const;

private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
};

}  // namespace caustics::bench
