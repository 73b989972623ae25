#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "core/base/atomic_file.h"
#include "tests/cli/program.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

using support::ProgramResult;
using support::shell;

/// Pictures of strangers, as the program meets them.
class Pictures : public testing::Test {
protected:
    Pictures() { write_atomic_file(folder_ / "scene.json", support::scene_of_picture("floor")); }

    void put(const std::string& bytes) const { write_atomic_file(folder_ / "floor", bytes); }

    /// $D is the test's folder, $H that of the programs that decode.
    ProgramResult run(const std::string& line) const {
        return shell(fmt::format("D='{}'; H=$(dirname $P)/'{}'; {}", folder_.path().string(),
                                 CAUSTICS_PICTURE_PROGRAMS, line));
    }
    ProgramResult render() const {
        return run("$P render $D/scene.json --method none --spp 1 -o $D/out.exr");
    }

    support::TemporaryFolder folder_;
};

// A copy of the program whose decoder is this script of shell; its socket is standard input.
TEST_F(Pictures, ADecoderThatEndsIsOneLineAndExitCode2) {
    put("P3\n2 1\n255\n255 0 0 0 255 0\n");
    struct End {
        const char* script;
        const char* reason;
    };
    const End ends[] = {
        {"kill -SEGV $$", "decoding it ended by signal 11, Segmentation fault"},
        {"kill -ABRT $$", "decoding it ended by signal 6, Aborted"},
        {"exit 3", "decoding it ended with exit code 3"},
        {"head -c 99 /dev/zero >&0; sleep 100",
         "the process that decodes it gave another answer than was asked for"},
        {"yes >&0", "the process that decodes it gave another answer than was asked for"},
    };
    for (const End& end : ends) {
        const ProgramResult result =
            run(fmt::format("mkdir -p $D/a/b/bin && cp $P $D/a/b/bin/ && cd $D/a/b/bin && "
                            "mkdir -p {0} && printf '#!/bin/sh\n{1}\n' "
                            ">{0}/read_foreign_pictures && chmod +x {0}/read_foreign_pictures && "
                            "./causticbench info $D/scene.json",
                            CAUSTICS_PICTURE_PROGRAMS, end.script));
        EXPECT_EQ(result.exit_code, 2) << end.script << ": " << result.err;
        EXPECT_NE(result.err.find(fmt::format("floor: cannot be read ({})", end.reason)),
                  std::string::npos)
            << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
}

TEST_F(Pictures, QuickInfoReadsHeadersAlone) {
    // 4096 x 4096 pixels are declared, and hardly any is there.
    put("P6\n4096 4096\n255\nabc");
    const ProgramResult info = run("$P info $D/scene.json --quick");
    EXPECT_EQ(info.exit_code, 0) << info.err;
    for (const ProgramResult& whole : {run("$P info $D/scene.json"), render()}) {
        EXPECT_EQ(whole.exit_code, 2);
        EXPECT_NE(whole.err.find("floor: cannot be read ("), std::string::npos) << whole.err;
    }
}

TEST_F(Pictures, InfoNamesThePhotonsOfAGlobalMapByThePicture) {
    const auto photons = [&] { return run("$P info $D/scene.json --quick | grep '^photons'").out; };
    put("P3\n1 1\n255\n255 0 0\n");
    const std::string red = photons();
    EXPECT_EQ(photons(), red);
    put("P3\n1 1\n255\n0 255 0\n");
    EXPECT_NE(photons(), red);
}

}  // namespace
}  // namespace caustics
