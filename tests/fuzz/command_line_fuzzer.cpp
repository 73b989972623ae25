#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/scene/scene_reader.h"
#include "experiments/cli/command_line.h"
#include "experiments/plan/sweep_selection.h"
#include "experiments/run/method.h"
#include "experiments/run/methods.h"
#include "tests/fuzz/reading.h"
#include "tests/fuzz/small_scene.h"

// Each line of the input is a word of the command line.

namespace {

using namespace caustics;
using namespace caustics::experiments;

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    std::istringstream in{std::string(text)};
    // A word of a command line holds no NUL.
    for (std::string word; std::getline(in, word);)
        words.push_back(word.substr(0, word.find('\0')));
    return words;
}

void parse_line(const std::vector<std::string>& words) {
    std::vector<const char*> arguments = {"causticbench"};
    for (const std::string& word : words) arguments.push_back(word.c_str());
    parse_command_line(static_cast<int>(arguments.size()), arguments.data());
}

void parse_parameters(const std::vector<std::string>& words) {
    const JsonNode node = parameters_node(words);
    for (const std::string& name : method_names())
        fuzz::taken(fuzz::Naming::nothing, [&] {
            const Method method = parse_method(name, parameters_node(words));
            // What is in force is read back to the same.
            const auto inforce = describe(method);
            fuzz::require(inforce == describe(parse_method(
                                         name, JsonNode::parse_text(inforce.dump(), "in force"))),
                          "parameters in force that read back to others");
        });
    for (const std::string& name : indirect_names())
        fuzz::taken(fuzz::Naming::nothing, [&] { parse_indirect(name, parameters_node(words)); });
}

void set_values(const std::vector<std::string>& words) {
    Overrides sets;
    for (const std::string& word : words) {
        const std::size_t equals = std::min(word.find('='), word.size());
        if (word.find("resolution") != std::string::npos) return;  // much work
        sets.emplace_back(word.substr(0, equals), word.substr(std::min(equals + 1, word.size())));
    }
    fuzz::taken(fuzz::Naming::file, [&] { load_scene(fuzz::scratch() / "small.json", sets); });
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    fuzz::put("small.json", fuzz::small_scene);
    std::filesystem::current_path(fuzz::scratch());
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::vector<std::string> words = words_of(fuzz::view(data, size));
    fuzz::taken(fuzz::Naming::nothing, [&] { parse_line(words); });
    // The program refuses what is no UTF-8 before all else.
    if (!is_utf8(fuzz::view(data, size))) return 0;
    for (const std::string& word : words)
        fuzz::taken(fuzz::Naming::nothing, [&] {
            const Shard shard = parse_shard(word);
            fuzz::require(1 <= shard.index && shard.index <= shard.count, "no part of a whole");
        });
    fuzz::taken(fuzz::Naming::nothing, [&] { parse_parameters(words); });
    set_values(words);
    return 0;
}
