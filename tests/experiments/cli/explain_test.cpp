#include "experiments/cli/explain.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/base/file_io.h"
#include "experiments/plan/plan_file.h"
#include "experiments/plan/trial_store.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class Explanations : public testing::Test {
protected:
    std::string text() {
        store_.prepare();
        write_plan(plan_, folder_.path());
        store_.begin("a");
        store_.commit("a", record_);
        return explain(folder_.path(), "a");
    }
    std::string error() {
        try {
            return "no error, but " + text();
        } catch (const InputError& error) {
            return error.what();
        }
    }
    support::TemporaryFolder folder_;
    TrialStore store_{folder_.path()};
    PlanFile plan_{{{"a", "a", 1, true}}, {}, {"sweep.json"}, {}, "/"};
    json record_ = {{"trial", "a"},
                    {"status", "done"},
                    {"seed", 3},
                    {"spp", 4},
                    {"threads", 1},
                    {"isa", "avx512"},
                    {"code_version", "1"},
                    {"picture_hash", "0123456789abcdef"},
                    {"scene", {{"file", "/no/scene.json"}, {"hash", "0"}}},
                    {"method", {{"name", "none"}, {"parameters", json::object()}}}};
};

TEST_F(Explanations, NameEverythingThatARunNeeds) {
    const std::string told = text();
    EXPECT_NE(told.find(" render /no/scene.json --method none --spp 4 --seed 3 --threads 1 --isa "
                        "avx512 -o a.exr\n"),
              std::string::npos)
        << told;
    EXPECT_NE(told.find("# picture 0123456789abcdef\n"), std::string::npos) << told;
}

TEST_F(Explanations, KeepRemarksOnOneLine) {
    record_["code_version"] = "1\ntouch a\x1b[2J";
    record_["message"] = "b\r\ntouch b";
    plan_.sweeps = {"c\ntouch c"};
    const std::string told = text();
    for (const char* line : {"\ntouch a", "\ntouch b", "\ntouch c", "\x1b"})
        EXPECT_EQ(told.find(line), std::string::npos) << told;
    EXPECT_NE(told.find("\"$(printf '/c\\012touch c')\""), std::string::npos) << told;
}

TEST_F(Explanations, TakeOnlyHashesAndInstructionSetsForThese) {
    record_["picture_hash"] = "0123456789abcde;";
    EXPECT_NE(error().find("record.json: broken record (/picture_hash: is no hash)"),
              std::string::npos)
        << error();
    record_.erase("picture_hash");
    record_["isa"] = "avx2; touch a";
    EXPECT_NE(error().find("(/isa: names no instruction set)"), std::string::npos) << error();
    record_["isa"] = "avx2";
    record_["threads"] = 5'000'000'000;
    EXPECT_NE(error().find("(/threads: 5000000000 is too large)"), std::string::npos) << error();
}

TEST_F(Explanations, GiveNoCommandThatOverwritesAFile) {
    record_["method"] = {{"name", "photonmap"}, {"parameters", {{"save", "/home/me/.profile"}}}};
    EXPECT_NE(error().find("names a file to write"), std::string::npos) << error();
}

}  // namespace
}  // namespace caustics::experiments
