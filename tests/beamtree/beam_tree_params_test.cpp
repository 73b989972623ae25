#include <gtest/gtest.h>

#include "beamtree/beam_tree_method.h"
#include "core/base/error.h"

namespace caustics::beamtree {
namespace {

BeamTreeParams params(const std::string& text) {
    return beamtree_method().read(JsonNode::parse_text(text, "test"));
}

std::string error(const std::string& text) {
    try {
        params(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(BeamTreeParams, AreTheBestByDefault) {
    const BeamTreeParams p = params("{}");
    EXPECT_EQ(p.bound, Bound::two_slice);
    EXPECT_EQ(p.hierarchy, BeamTreeParams::Tree::binned);
    EXPECT_EQ(p.leaf, BeamTreeParams::Leaf::fixed);
    EXPECT_EQ(p.intensity, Intensity::refined);
}

TEST(BeamTreeParams, AreThePapersByPreset) {
    const BeamTreeParams p = params(R"({"preset": "chuang1995"})");
    EXPECT_EQ(p.merging, ConeTreeSettings::Merging::cones);
    EXPECT_EQ(p.intensity, Intensity::area);
    EXPECT_EQ(p.bound, Bound::hybrid);
    EXPECT_EQ(p.spread_threshold, 10);
    EXPECT_EQ(p.hierarchy, BeamTreeParams::Tree::quadtree);
    EXPECT_EQ(p.leaf, BeamTreeParams::Leaf::receiver);
}

TEST(BeamTreeParams, AreRead) {
    const BeamTreeParams p = params(
        R"({"bound": "double", "hierarchy": "binned", "leaf": "k", "intensity": "area",
            "light_samples": 9, "mesh_resolution": 32, "max_bounces": 1, "merging": "cones",
            "polygons": "quads"})");
    EXPECT_EQ(p.bound, Bound::double_cone);
    EXPECT_EQ(p.hierarchy, BeamTreeParams::Tree::binned);
    EXPECT_EQ(p.leaf, BeamTreeParams::Leaf::fixed);
    EXPECT_EQ(p.light_samples, 9);
    EXPECT_EQ(p.mesh_resolution, 32);
    EXPECT_EQ(p.max_bounces, 1);
    EXPECT_EQ(p.merging, ConeTreeSettings::Merging::cones);
    EXPECT_EQ(p.polygons, PolygonKind::quad);
    EXPECT_EQ(p.intensity, Intensity::area);
    EXPECT_EQ(params(R"({"intensity": "refined"})").intensity, Intensity::refined);
    EXPECT_EQ(params(R"({"spread_threshold": 4.5})").spread_threshold, 4.5);
}

TEST(BeamTreeParams, TwoSliceBringsWhatFitsIt) {
    const BeamTreeParams p = params(R"({"bound": "two_slice"})");
    EXPECT_EQ(p.bound, Bound::two_slice);
    EXPECT_EQ(p.leaf, BeamTreeParams::Leaf::fixed);
    EXPECT_EQ(p.hierarchy, BeamTreeParams::Tree::binned);
    EXPECT_EQ(params(R"({"bound": "two_slice", "hierarchy": "quadtree", "leaf": "k"})").hierarchy,
              BeamTreeParams::Tree::quadtree);
    EXPECT_NE(error(R"({"bound": "two_slice", "leaf": "n"})").find("would lose light"),
              std::string::npos);
    EXPECT_NE(error(R"({"bound": "two_slice", "merging": "cones"})").find("no cones"),
              std::string::npos);
    EXPECT_NE(error(R"({"bound": "two_slice", "spread_threshold": 5})").find("hybrid"),
              std::string::npos);
}

TEST(BeamTreeParams, AveragesOverSquaresOfTheSlicesPlanes) {
    EXPECT_EQ(params(R"({"bound": "two_slice"})").footprint, 0);
    EXPECT_EQ(params(R"({"bound": "two_slice", "footprint": 0.5})").footprint, 0.5F);
    EXPECT_NE(error(R"({"bound": "single", "footprint": 0.5})").find("two_slice"),
              std::string::npos);
    for (const char* const value : {"0", "-1", "1e30", "1e-30"})
        EXPECT_NE(error(R"({"bound": "two_slice", "footprint": )" + std::string(value) + "}")
                      .find("above 0"),
                  std::string::npos)
            << value;
    EXPECT_NE(error(R"({"footprint": 9e-16})").find("1e-15 m or more"), std::string::npos);
    EXPECT_EQ(params(R"({"footprint": 1e-15})").footprint, 1e-15F);
}

TEST(BeamTreeParams, AverageOverPixels) {
    EXPECT_TRUE(params("{}").pixel_footprint);
    EXPECT_FALSE(params(R"({"pixel_footprint": false})").pixel_footprint);
    for (const std::string other :
         {R"("bound": "hybrid")", R"("preset": "chuang1995")", R"("footprint": 0.1)",
          R"("wavelengths": 4, "dispersion": "intervals")"})
        EXPECT_FALSE(params("{" + other + "}").pixel_footprint) << other;
    for (const std::string other :
         {R"("bound": "hybrid")", R"("preset": "chuang1995")", R"("footprint": 0.1)",
          R"("wavelengths": 4, "dispersion": "intervals")"}) {
        const std::string line = error(R"({"pixel_footprint": true, )" + other + "}");
        EXPECT_NE(line.find("footprint"), std::string::npos) << line;
    }
}

// Who gives a parameter of beams asks about beams.
TEST(BeamTreeParams, LeaveLightToPencilsUnlessBeamsAreAskedFor) {
    using Rest = BeamTreeParams::Rest;
    EXPECT_EQ(params("{}").rest, Rest::pencils);
    EXPECT_EQ(params("{}").max_bounces, most_bounces);
    EXPECT_EQ(params(R"({"max_bounces": 3})").max_bounces, 3);
    EXPECT_EQ(params(R"({"light_samples": 4})").rest, Rest::pencils);
    for (const std::string asked :
         {R"("max_beams": 1000)", R"("prune": 0)", R"("mesh_resolution": 8)", R"("root_events": 3)",
          R"("polygons": "triangles")", R"("bound": "hybrid")", R"("intensity": "area")",
          R"("bound": "two_slice")", R"("hierarchy": "binned")"}) {
        EXPECT_EQ(params("{" + asked + "}").rest, Rest::max_beams) << asked;
        EXPECT_EQ(params("{" + asked + "}").max_bounces, preset_bounces) << asked;
        EXPECT_EQ(params(R"({"rest": "pencils", )" + asked + "}").rest, Rest::pencils) << asked;
    }
    EXPECT_EQ(params(R"({"preset": "chuang1995"})").rest, Rest::none);
    EXPECT_EQ(params(R"({"beam_events": 2})").beam_events, 2);
    EXPECT_NE(error(R"({"beam_events": 2, "rest": "none"})").find("pencils"), std::string::npos);
    EXPECT_NE(error(R"({"beam_events": -1})"), "no error");
}

TEST(BeamTreeParams, NameTheAlternatives) {
    EXPECT_NE(error(R"({"bound": "tripple"})").find("sphere_swept"), std::string::npos);
    EXPECT_NE(error(R"({"intensity": "fine"})").find("refined"), std::string::npos);
    EXPECT_NE(error(R"({"bound": "single", "spread_threshold": 5})").find("hybrid"),
              std::string::npos);
    EXPECT_NE(error(R"({"spread_threshold": -1})"), "no error");
    EXPECT_NE(error(R"({"light_samples": 0})"), "no error");
    EXPECT_NE(error(R"({"polygons": "pentagons"})").find("triangles"), std::string::npos);
    EXPECT_NE(error(R"({"samples": 4})").find("light_samples"), std::string::npos);
}

}  // namespace
}  // namespace caustics::beamtree
