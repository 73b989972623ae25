#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/scene/scene_reader.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/verbs.h"
#include "experiments/plan/sweep_selection.h"
#include "experiments/run/method.h"
#include "experiments/run/methods.h"
#include "tests/fuzz/json_mutator.h"
#include "tests/fuzz/reading.h"
#include "tests/fuzz/small_scene.h"
#include "tests/fuzz/word_hooks.h"

// Each line of the input is a word. After "param" and "indirect" come a method's name and what it is given by
// --param, after "set" what a scene is given by --set, after "slurm" what a task of an array finds in its surroundings; all else
// is a command line, and each of its words a shard.

namespace {

using namespace caustics;
using namespace caustics::experiments;

using Words = std::vector<std::string>;

Words words_of(std::string_view text) {
    Words words;
    std::istringstream in{std::string(text)};
    // A word of a command line holds no NUL.
    for (std::string word; std::getline(in, word);)
        words.push_back(word.substr(0, word.find('\0')));
    return words;
}

void parse_line(const Words& words) {
    std::vector<const char*> arguments = {"causticbench"};
    for (const std::string& word : words) arguments.push_back(word.c_str());
    parse_command_line(static_cast<int>(arguments.size()), arguments.data());
}

void parse_shards(const Words& words) {
    for (const std::string& word : words)
        fuzz::taken(fuzz::Naming::nothing, [&] {
            const Shard shard = parse_shard(word);
            fuzz::require(1 <= shard.index && shard.index <= shard.count, "no part of a whole");
        });
}

void parse_array_task(const Words& numbers) {
    const char* const names[] = {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN",
                                 "SLURM_ARRAY_TASK_MAX", "SLURM_ARRAY_TASK_COUNT"};
    for (std::size_t i = 0; i < std::size(names); ++i)
        if (i + 1 < numbers.size())
            setenv(names[i], numbers[i + 1].c_str(), 1);
        else
            unsetenv(names[i]);
    parse_shards({"auto"});
}

void parse_parameters(const std::string& name, const Words& assignments) {
    const Method method = parse_method(name, parameters_node(assignments));
    // What is in force is read back to the same.
    const auto inforce = describe(method);
    fuzz::require(
        inforce == describe(parse_method(name, JsonNode::parse_text(inforce.dump(), "in force"))),
        "parameters in force that read back to others");
}

void set_values(const Words& assignments) {
    Overrides sets;
    for (const std::string& word : assignments) {
        const std::size_t equals = std::min(word.find('='), word.size());
        if (word.find("resolution") != std::string::npos) return;  // much work
        sets.emplace_back(word.substr(0, equals), word.substr(std::min(equals + 1, word.size())));
    }
    load_scene(fuzz::named("small.json"), sets);
}

void parse(const Words& words) {
    const std::string& first = words[0];
    const bool two = words.size() > 1;
    if (first == "set")
        set_values({words.begin() + 1, words.end()});
    else if (first == "slurm")
        parse_array_task(words);
    else if (first == "param" && two)
        parse_parameters(words[1], {words.begin() + 2, words.end()});
    else if (first == "indirect" && two)
        parse_indirect(words[1], parameters_node({words.begin() + 2, words.end()}));
    else
        parse_line(words);
}

}  // namespace

const std::vector<std::string>& caustics::fuzz::words() {
    static const Words all = [] {
        std::vector<ObjectText> objects;
        for (const MethodDescription* method : all_methods())
            objects.push_back({method->facts().name, "", method->parameters()});
        for (const IndirectDescription* method : all_indirect_methods())
            objects.push_back({method->facts().name, "", method->parameters()});
        Words known = fuzz::words_of(objects);
        CLI::App app;
        for (const Verb& verb : add_verbs(app)) {
            known.push_back(verb.app->get_name());
            for (const CLI::Option* option : verb.app->get_options())
                known.push_back(option->get_name(false, true));
        }
        for (const char* word : {"param",
                                 "indirect",
                                 "set",
                                 "small.json",
                                 "a.exr",
                                 "out",
                                 "-o",
                                 "--",
                                 "1/2",
                                 "auto",
                                 "/ball/radius",
                                 "/lamp/intensity",
                                 "/floor/bsdf",
                                 "/camera/film/width",
                                 "/",
                                 "/ball/~1",
                                 "[1,2,3]",
                                 "{\"type\":\"phong\"}",
                                 "{\"$include\":\"small.json\"}",
                                 "true",
                                 "null",
                                 "\"x\""})
            known.emplace_back(word);
        return known;
    }();
    return all;
}

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    caustics::fuzz::words();  // by the tables of all readers
    fuzz::put("small.json", fuzz::small_scene);
    std::filesystem::current_path(fuzz::scratch());
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::view(data, size);
    const Words words = words_of(text);
    if (words.empty()) return 0;
    // The program refuses what is no UTF-8 before all else.
    const bool is_text = is_utf8(text);
    fuzz::taken(fuzz::Naming::nothing, [&] { is_text ? parse(words) : parse_line(words); });
    if (is_text) parse_shards(words);
    return 0;
}
