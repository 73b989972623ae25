#include <gtest/gtest.h>

#include "beamtree/beam_tree.h"
#include "core/render/renderer.h"
#include "core/scene/scene_reader.h"

namespace caustics {
namespace {

Counters counts(const char* resolution, const beamtree::BeamTreeParams& params) {
    const SceneFile file =
        load_scene(CAUSTICS_SOURCE_DIR "/experiments/scenes/pool_waves.json",
                   {{"/water/to_world/0/scale/2", "2.5"}, {"/water/resolution", resolution}});
    const Scene scene(file.desc);
    RunOptions options;
    options.threads = 2;
    const auto method = build(scene, params, options);
    return render(scene, *method, options).report.counters;
}

void expect_near_the_paper(const Counters& counted) {
    EXPECT_EQ(counted.at("camera_rays"), 10'000U);
    const std::pair<const char*, double> paper[] = {
        {"cone_point_tests", 1'293'973}, {"beam_point_tests", 68'648}, {"beam_point_hits", 12'960}};
    for (const auto& [name, count] : paper) {
        const double ratio = static_cast<double>(counted.at(name)) / count;
        EXPECT_GT(ratio, 0.5) << name;
        EXPECT_LT(ratio, 2) << name;
    }
}

// [CC95 sec. 3.3]: 100 x 100 pixels, 7575 polygons; 61 x 61 cells in triangles, and 87 x 87 quads.
// results/beamtree has all bounds and other waves.
TEST(BeamCounts, AreThePapersWithinAFactorOfTwo) {
    beamtree::BeamTreeParams params = beamtree::BeamTreeParams::chuang1995();
    params.merging = beamtree::ConeTreeSettings::Merging::rays;
    expect_near_the_paper(counts("61", params));
    params.polygons = beamtree::PolygonKind::quad;
    expect_near_the_paper(counts("87", params));
}

}  // namespace
}  // namespace caustics
