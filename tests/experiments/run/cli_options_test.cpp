#include "experiments/run/cli_options.h"

#include <gtest/gtest.h>

#include "tests/experiments/refusal.h"
#include "tests/experiments/terminal.h"

namespace caustics::experiments {
namespace {

TEST(SceneOptions, SetValuesAtPointers) {
    SceneOptions options;
    options.sets = {"/a=1", "/b/c=x=y"};
    EXPECT_EQ(options.overrides(), (Overrides{{"/a", "1"}, {"/b/c", "x=y"}}));
    for (const std::string set : {"=1", "=", "/a"}) {
        options.sets = {set};
        EXPECT_EQ(refusal_of([&] { options.overrides(); }),
                  "--set \"" + set + "\": expected /json/pointer=value");
    }
}

TEST(SceneOptions, NameTheSceneOnATerminalWhileItIsRead) {
    SceneOptions options;
    options.file = CAUSTICS_SOURCE_DIR "/tests/experiments/scenes/ball.json";
    Terminal terminal(200);
    EXPECT_EQ(options.load().desc.shapes.size(), 2U);
    const std::string written = terminal.text();
    EXPECT_NE(written.find("reading "), std::string::npos) << written;
    EXPECT_TRUE(written.ends_with("\r\033[K")) << "it stays: " << written;
}

TEST(SamplesPerPixel, FitTheAdaptiveSampler) {
    PixelSampling adaptive;
    adaptive.max_sample_count = 16;
    EXPECT_EQ(samples_per_pixel(adaptive, 0), adaptive.sample_count);
    for (const int count : {2, 16}) EXPECT_EQ(samples_per_pixel(adaptive, count), count);
    for (const std::string count : {"1", "17"})
        EXPECT_EQ(refusal_of([&] { samples_per_pixel(adaptive, std::stoi(count)); }),
                  "--spp " + count +
                      ": the scene's adaptive sampler starts with 2 to 16 samples a pixel");
}

}  // namespace
}  // namespace caustics::experiments
