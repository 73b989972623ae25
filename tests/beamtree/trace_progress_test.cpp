#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "beamtree/beam_tree.h"
#include "beamtree/caustic_polygons.h"
#include "core/base/error.h"
#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

// A ball of glass, whose light is followed over several events: one caster, one light, so that
// all of the phase is one part.
Scene glass_ball() {
    SceneDesc desc;
    desc.shapes = {support::sphere("ball", {0, 0, 0.6}, 0.5, support::glass(1.5F)),
                   support::horizontal("floor", 0, 4, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({1.5, 0.4, 1.6}, 5)};
    return Scene(std::move(desc));
}

struct Phase {
    std::string name;
    std::vector<double> shares;
};

template <typename Params>
std::vector<Phase> phases(const Params& params) {
    std::vector<Phase> all;
    RunOptions options;
    options.begin_phase = [&](std::string_view name) { all.push_back({std::string(name), {}}); };
    options.progress = [&](double share) { all.back().shares.push_back(share); };
    build(glass_ball(), params, options);
    return all;
}

// The shares of a phase grow, from near 0 to near 1, by steps of a few percent at most.
void expect_steady(const Phase& phase) {
    double last = 0;
    for (const double share : phase.shares) {
        EXPECT_GE(share, last) << phase.name;
        EXPECT_LE(share - last, 0.1) << phase.name << " at " << last;
        last = share;
    }
    // Pieces of work that come to nothing (beams without light that goes on) leave their share out.
    EXPECT_GT(last, 0.5) << phase.name;
    EXPECT_LE(last, 1) << phase.name;
}

TEST(TraceProgress, GrowsSteadilyWhileBeamsAreTraced) {
    for (const Intensity intensity : {Intensity::area, Intensity::refined})
        for (const int bounces : {1, 2, 16}) {
            if (bounces == 2 && intensity == Intensity::area) continue;  // it ends before refining
            BeamTreeParams params;
            params.rest = BeamTreeParams::Rest::max_beams;
            params.intensity = intensity;
            params.max_bounces = bounces;
            const std::vector<Phase> found = phases(params);
            ASSERT_EQ(found.front().name, "beams");
            expect_steady(found.front());
            if (bounces == 1 && intensity == Intensity::refined) {
                EXPECT_NEAR(found.front().shares.back(), 1, 1e-9);
            }
            // And not before the end.
            const auto whole = std::ranges::count_if(found.front().shares,
                                                     [](double share) { return share > 1 - 1e-9; });
            EXPECT_LE(whole, 2) << bounces << " of " << found.front().shares.size();
            ASSERT_EQ(found.back().name, "tree");
            EXPECT_NEAR(found.back().shares.back(), 1, 1e-9);
        }
    CausticPolygonsParams polygons;
    polygons.receiver_resolution = 4;
    polygons.mesh_resolution = 16;
    const std::vector<Phase> found = phases(polygons);
    ASSERT_EQ(found.back().name, "polygons");
    expect_steady(found.back());
}

// Each report may end the build: none of them is far from the one before.
TEST(TraceProgress, AnInterruptEndsTheBuild) {
    for (const int after : {1, 10, 100, 1000}) {
        int count = 0;
        RunOptions options;
        options.progress = [&](double) {
            if (++count >= after) throw Interrupted();
        };
        EXPECT_THROW(build(glass_ball(), BeamTreeParams{}, options), Interrupted) << after;
        EXPECT_EQ(count, after);
    }
}

}  // namespace
}  // namespace caustics::beamtree
