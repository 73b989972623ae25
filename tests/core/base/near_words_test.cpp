#include "core/base/near_words.h"

#include <gtest/gtest.h>

namespace caustics {
namespace {

using Words = std::vector<std::string>;

TEST(NearWords, AreAtMostTwoEditsAway) {
    const Words known = {"photons", "nearest", "spp"};
    EXPECT_EQ(near_words("photons", known), Words{"photons"});
    EXPECT_EQ(near_words("photns", known), Words{"photons"});
    EXPECT_EQ(near_words("pohtosn", known), Words{"photons"}) << "two swaps";
    EXPECT_EQ(near_words("phootonss", known), Words{"photons"});
    EXPECT_EQ(near_words("neerast", known), Words{"nearest"});
    EXPECT_EQ(near_words("phtn", known), Words{}) << "three letters are missing";
    EXPECT_EQ(near_words("PHOTONS", known), Words{"photons"});
    EXPECT_EQ(near_words("", known), Words{});
}

TEST(NearWords, AreTheNearestOnesAlone) {
    const Words known = {"radius", "max_radius", "min_radius", "radios"};
    EXPECT_EQ(near_words("radiu", known), Words{"radius"});
    EXPECT_EQ(near_words("mx_radius", known), Words{"max_radius"});
    EXPECT_EQ(near_words("m_radii", {"max_radii", "min_radii"}), (Words{"max_radii", "min_radii"}));
    EXPECT_EQ(near_words("radius", known), Words{"radius"});
}

TEST(NearWords, ShareALetterWithTheWord) {
    EXPECT_EQ(near_words("k", {"n", "kk"}), Words{"kk"});
    EXPECT_EQ(near_words("ab", {"cd", "ac"}), Words{"ac"});
    EXPECT_EQ(near_words("", {"a", "ab"}), Words{});
}

TEST(NearWords, AreNamedInOneQuestion) {
    EXPECT_EQ(did_you_mean("hybird", {"single", "hybrid"}), ": did you mean hybrid?");
    EXPECT_EQ(did_you_mean("axe", {"axes", "axle"}), ": did you mean axes or axle?");
    EXPECT_EQ(did_you_mean("sphere", {"single", "hybrid"}), "");
}

}  // namespace
}  // namespace caustics
