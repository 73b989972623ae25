#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/base/file_io.h"
#include "experiments/cli/explain.h"
#include "experiments/plan/plan_file.h"
#include "experiments/plan/trial_store.h"
#include "experiments/sweep/merge.h"
#include "experiments/sweep/sweep.h"
#include "tests/experiments/sweep/plan_of.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// A text that leaves its folder, its line, its word and its quotes where it can.
const std::string hostile =
    "../../pwned\ntouch pwned\n$(touch pwned)`touch pwned`;touch pwned;'touch pwned'\"|touch pwned";

/// A copy of real results, in which one thing after the other is not as the program wrote it. What a
/// verb says then is its own business; here it is none of a crash, of an error without a place, of
/// anything written elsewhere or run, and a sweep that ends leaves whole records.
class ForeignFolders : public testing::Test {
protected:
    void SetUp() override {
        write_atomic_file(folder_ / "sweep.json", R"({"version": 1, "scenes": [")" +
                                                      std::string(CAUSTICS_SOURCE_DIR) +
                                                      R"(/tests/experiments/scenes/ball.json"],
            "spp": 1, "seeds": [1, 2],
            "set": {"film": {"pointer": "/sensor/film/width", "values": [8]}},
            "methods": [{"method": "photonmap", "param": {"emitted": [20]}}],
            "reference": {"method": "lighttrace", "param": {"paths": 20}}})");
        plan_ = plan_of(folder_ / "sweep.json");
        ASSERT_EQ(sweep(original_), 0);
    }
    int sweep(const fs::path& folder) const {
        SweepOptions options;
        options.folder = folder;
        return run_sweep(plan_, options);
    }
    const std::string& trial() const { return plan_.trials[0].id; }

    /// Does all verbs with the results changed so.
    void check(const std::string& what, const std::function<void(const fs::path&)>& change) {
        SCOPED_TRACE(what);
        fs::create_directories(lab_);
        fs::copy(original_, results_, fs::copy_options::recursive);
        change(results_);
        is_refused_or([&] { explain_all(); });
        is_refused_or([&] { merge_results({results_}, lab_ / "far/merged"); });
        is_refused_or([&] {
            sweep(results_);
            for (const Trial& trial : plan_.trials)
                EXPECT_TRUE(TrialStore(results_).record(trial.id)) << trial.id;
        });
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_.path()))
            EXPECT_EQ(entry.path().string().find("pwned"), std::string::npos) << entry.path();
        for (const fs::directory_entry& entry : fs::directory_iterator(lab_))
            EXPECT_TRUE(entry.path().filename() == "results" || entry.path().filename() == "far");
        fs::remove_all(lab_);
    }

private:
    /// The program turns both into one line with a place (main.cpp).
    static void is_refused_or(const std::function<void()>& work) {
        try {
            work();
        } catch (const InputError& error) {
            EXPECT_STRNE(error.what(), "");
        } catch (const fs::filesystem_error& error) {
            EXPECT_FALSE(error.path1().empty()) << error.what();
        } catch (const std::exception& error) {
            ADD_FAILURE() << error.what();
        }
    }
    /// Remarks and one command, which runs nothing but itself.
    void explain_all() const {
        const PlanFile plan = read_plan_of(results_);
        for (const PlanFile::Entry& entry : plan.trials) is_refused_or([&] { run(entry.id); });
    }
    void run(const std::string& id) const {
        std::string text = explain(results_, id);
        std::size_t commands = 0;
        for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
            if (text[at] == '#') continue;
            ++commands;
            text.replace(at, text.find(' ', at) - at, "true");
        }
        EXPECT_EQ(commands, 1U) << text;
        write_atomic_file(folder_ / "script", text);
        const std::string run = "cd '" + folder_.path().string() + "' && sh script";
        EXPECT_EQ(std::system(run.c_str()), 0) << text;
    }

    support::TemporaryFolder folder_;
    fs::path original_ = folder_ / "original";
    fs::path lab_ = folder_ / "lab";
    fs::path results_ = lab_ / "results";
    SweepPlan plan_;
};

/// The places of all values of a JSON file but those deep inside the scene.
std::vector<json::json_pointer> places_in(const json& file) {
    std::vector<json::json_pointer> places;
    const std::function<void(const json::json_pointer&)> visit = [&](const auto& place) {
        places.push_back(place);
        const json& value = file.at(place);
        if (place == json::json_pointer("/scene/resolved") || !value.is_structured()) return;
        for (const auto& member : value.items())
            visit(value.is_array() ? place / std::stoul(member.key()) : place / member.key());
    };
    visit(json::json_pointer());
    return places;
}

/// Values of other types than the one that is there, and hostile texts. A few, or with
/// CAUSTICS_FOREIGN=all each by itself.
std::vector<json> values_for(const json& value, std::size_t round) {
    std::vector<json> all = {hostile, -1.5, json::array({1}), json{{"a", 1}}, true,
                             nullptr, "",   "interrupted",    1e300,          -1};
    std::erase_if(all, [&](const json& other) { return other.type() == value.type(); });
    if (value.is_string()) all.insert(all.begin(), hostile);
    const char* const wanted = std::getenv("CAUSTICS_FOREIGN");
    if (wanted != nullptr && std::string(wanted) == "all") return all;
    return {all[0], all[1 + round % (all.size() - 1)]};
}

TEST_F(ForeignFolders, MayHoldAnyValueAnywhere) {
    for (const std::string& name : std::vector<std::string>{"plan.json", "environment.json",
                                                            "trials/" + trial() + "/record.json"}) {
        json file;
        std::size_t round = 0;
        check(name + " as it is",
              [&](const fs::path& folder) { file = json::parse(read_whole_file(folder / name)); });
        for (const json::json_pointer& place : places_in(file))
            for (const json& value : values_for(file.at(place), round++))
                check(name + ": " + place.to_string() + ": " + value.dump(),
                      [&](const fs::path& folder) {
                          json changed = file;
                          changed[place] = value;
                          write_atomic_file(folder / name, changed.dump());
                      });
    }
}

TEST_F(ForeignFolders, MayNestValuesSoDeepThatPrintingThemWouldEndTheStack) {
    const std::string deep = std::string(300'000, '[') + std::string(300'000, ']');
    for (const std::string& name : {std::string("plan.json"), std::string("environment.json"),
                                    std::string(".table"), "trials/" + trial() + "/record.json"})
        for (const char* key : {"version", "swept", "status", "method"})
            check(name + ": " + key, [&](const fs::path& folder) {
                std::string text = read_whole_file(folder / name);
                text.insert(text.find('{') + 1, "\"" + std::string(key) + "\":" + deep + ",");
                write_atomic_file(folder / name, text);
            });
}

TEST_F(ForeignFolders, MayLackAnyFileOrHoldAnythingInItsPlace) {
    const std::vector<std::pair<std::string, std::function<void(const fs::path&)>>> changes = {
        {"removed", [](const fs::path& file) { fs::remove_all(file); }},
        {"empty", [](const fs::path& file) { write_atomic_file(file, ""); }},
        {"cut", [](const fs::path& file) { fs::resize_file(file, fs::file_size(file) / 2); }},
        {"a folder",
         [](const fs::path& file) {
             fs::remove_all(file);
             fs::create_directory(file);
         }},
        {"a link to itself",
         [](const fs::path& file) {
             fs::remove_all(file);
             fs::create_symlink(file.filename(), file);
         }},
        {"a pipe", [](const fs::path& file) {
             fs::remove_all(file);
             mkfifo(file.c_str(), 0600);
         }}};
    std::vector<std::string> names;
    check("all as it is", [&](const fs::path& folder) {
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (entry.path().string().find(trial()) != std::string::npos ||
                entry.path().parent_path() == folder || entry.path().extension() == ".exr")
                names.push_back(fs::relative(entry.path(), folder));
    });
    EXPECT_GE(names.size(), 15U);
    for (const std::string& name : names)
        for (const auto& change : changes)
            check(name + " is " + change.first, [&](const fs::path& folder) {
                const bool of_files = change.first == "empty" || change.first == "cut";
                if (!of_files || !fs::is_directory(folder / name)) change.second(folder / name);
            });
}

}  // namespace
}  // namespace caustics::experiments
