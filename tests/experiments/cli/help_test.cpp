#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "experiments/cli/help_text.h"
#include "experiments/plan/record.h"
#include "experiments/plan/record_columns.h"
#include "experiments/plan/sweep_file.h"
#include "experiments/plan/sweep_keys.h"
#include "tests/support/known_words.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using Words = std::set<std::string>;

const std::string root = CAUSTICS_SOURCE_DIR "/";

TEST(Help, FitsIntoAHundredColumns) {
    std::vector<std::string> topics = help_topics();
    topics.emplace_back();
    for (const std::string& topic : topics) {
        std::istringstream text(help_text(topic));
        for (std::string line; std::getline(text, line);)
            EXPECT_LE(line.size(), 100U) << topic << ": " << line;
    }
}

TEST(Help, HasNoTextForAnUnknownTopic) { EXPECT_EQ(help_text("scenes"), ""); }

void expect_in_readme(const std::string& file, const std::string& topic) {
    const std::string section = "```text\n" + help_text(topic) + "```\n";
    EXPECT_NE(read_whole_file(root + file).find(section), std::string::npos)
        << file << ": put the output of `causticbench help " << topic
        << "` in place of what stands between ```text and ```";
}

TEST(Help, StandsInTheReadmes) {
    expect_in_readme("experiments/scenes/README.md", "scene");
    expect_in_readme("experiments/README.md", "sweep");
}

TEST(Help, TellsEveryColumnAsTheDocumentDoes) {
    const std::string document = read_whole_file(root + "results/records.md");
    Words told;
    for (const RecordColumn& column : record_columns_of_all()) {
        told.insert(column.name);
        const std::string unit = column.unit;
        const std::string row = "| `" + std::string(column.name) + "` |" +
                                (unit.empty() ? "" : " " + unit) + " | " + column.meaning + " |\n";
        EXPECT_NE(document.find(row), std::string::npos) << "results/records.md needs:\n" << row;
    }
    for (const std::string& column : record_columns({}))
        EXPECT_TRUE(told.contains(column)) << column;
}

/// The keys that a reader of sweep files knows, by its own message about one more key.
Words asked(const std::string& sweep) {
    const support::TemporaryFolder folder;
    const std::filesystem::path file = folder / "sweep.json";
    std::ofstream(file) << sweep;
    try {
        read_sweep_file(file);
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("(known: "), std::string::npos) << message;
        return support::known_words(message);
    }
    return {};
}

TEST(Help, TellsTheKeysThatSweepFilesAreReadBy) {
    const std::string scenes =
        R"("version": 1, "scenes": [")" + root + R"(tests/experiments/scenes/ball.json"])";
    const std::string methods = R"("methods": [{"method": "none"}])";
    const std::map<std::string, std::string> files = {
        {"sweep", "{" + scenes + ", " + methods + R"(, "more": 1})"},
        {"axis", "{" + scenes + ", " + methods +
                     R"(, "set": {"a": {"pointer": "/light", "values": [1], "more": 1}}})"},
        {"method", "{" + scenes + R"(, "methods": [{"method": "none", "more": 1}]})"},
        {"reference",
         "{" + scenes + ", " + methods + R"(, "reference": {"method": "lighttrace", "more": 1}})"}};
    for (const ObjectText& object : sweep_keys()) {
        Words told;
        for (const KeyText& key : object.keys) told.insert(key.key);
        EXPECT_EQ(asked(files.at(object.name)), told) << object.name;
    }
}

}  // namespace
}  // namespace caustics::experiments
