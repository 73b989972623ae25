#include "experiments/cli/help_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

#include "core/scene/scene_keys.h"
#include "experiments/plan/record_columns.h"
#include "experiments/plan/sweep_keys.h"
#include "experiments/run/method.h"
#include "experiments/run/methods.h"

namespace caustics::experiments {

namespace {

constexpr std::size_t widest = 100;

/// Words in lines of at most `widest` columns; the first line starts with `start`, the others with
/// as many blanks.
std::string wrapped(const std::string& start, const std::string& text) {
    std::string all, line = start;
    std::istringstream words(text);
    bool is_empty = true;
    for (std::string word; words >> word;) {
        if (!is_empty && line.size() + 1 + word.size() > widest) {
            all += line + "\n";
            line = std::string(start.size(), ' ');
            is_empty = true;
        }
        line += (is_empty ? "" : " ") + word;
        is_empty = false;
    }
    return all + line + "\n";
}

/// "whole number, 1 to 1000 paths, default 16 [J96 sec. 2]"
std::string kind_of_key(const KeyText& key) {
    std::string text = key.type == "choice" ? "one of " + key.choices : key.type;
    if (key.type != "choice" && !key.choices.empty()) text += ", " + key.choices;
    if (!key.unit.empty()) text += (key.choices.empty() ? ", " : " ") + key.unit;
    text += key.usual.empty() ? ", must be given" : ", default " + key.usual;
    if (!key.source.empty()) text += " " + key.source;
    return text;
}

std::string key_lines(const std::vector<KeyText>& keys) {
    std::string text;
    for (const KeyText& key : keys)
        text += wrapped(fmt::format("  {:<20} ", key.key), kind_of_key(key)) +
                wrapped(std::string(6, ' '), key.meaning);
    return text;
}

template <class Estimator>
std::string method_help(const MethodDescriptionOf<Estimator>& method, const std::string& option) {
    const MethodFacts& facts = method.facts();
    const std::vector<KeyText> keys = method.parameters();
    return wrapped(facts.name + ": ", facts.summary) + wrapped("serves: ", facts.serves) +
           (keys.empty() ? "no parameters\n"
                         : fmt::format("parameters ({} key=value, or \"param\" in a sweep file):\n",
                                       option)) +
           key_lines(keys);
}

/// Of the methods of the indirect layer with that name; all, where it is empty.
std::string indirect_help(const std::string& name) {
    std::string text;
    for (const IndirectDescription* method : all_indirect_methods())
        if (name.empty() || method->facts().name == name)
            text += "\nIn the indirect layer (--indirect):\n" +
                    method_help(*method, "--indirect-param");
    return text;
}

std::string all_indirect_help() {
    return "Light between diffuse surfaces: the layer `indirect`, by a method of its own.\n" +
           indirect_help({});
}

std::string object_help(const std::string& title, const std::vector<ObjectText>& objects) {
    std::string text = title;
    for (const ObjectText& object : objects)
        text += "\n" + wrapped(object.name + ": ", object.meaning) + key_lines(object.keys);
    return text;
}

std::string scene_help() {
    return object_help(
        "Scene files: JSON; each object with its keys, most named by their `type`.\n",
        scene_file::scene_keys());
}

std::string sweep_help() {
    return object_help("Sweep files: JSON; each object with its keys.\n", sweep_keys());
}

std::string record_help() {
    std::string text = "Columns of records.csv and records.jsonl; an empty field does not apply.\n";
    for (const RecordColumn& column : record_columns_of_all()) {
        const std::string unit = column.unit;
        text += fmt::format("  {}{}\n", column.name, unit.empty() ? "" : " [" + unit + "]") +
                wrapped(std::string(6, ' '), column.meaning);
    }
    return text;
}

/// A kind of file that help describes.
struct FileTopic {
    const char* name;
    const char* meaning;
    std::string (*text)();
};
constexpr FileTopic file_topics[] = {
    {"scene", "the keys of scene files", scene_help},
    {"sweep", "the keys of sweep files", sweep_help},
    {"records", "the columns of a sweep's table", record_help},
    {"indirect", "the methods of the indirect layer", all_indirect_help}};

std::string topic_list() {
    std::string text = "help TOPIC prints every key with its type, range, unit and default.\n";
    for (const MethodDescription* method : all_methods())
        text += wrapped(fmt::format("  {:<18} ", method->facts().name), method->facts().summary);
    for (const FileTopic& topic : file_topics)
        text += wrapped(fmt::format("  {:<18} ", topic.name), topic.meaning);
    return text +
           "[J96 (4)] is an equation, [J96 sec. 5] a section of a paper; PAPERS.md has the keys.\n";
}

}  // namespace

std::vector<std::string> help_topics() {
    std::vector<std::string> all = method_names();
    for (const FileTopic& topic : file_topics) all.emplace_back(topic.name);
    return all;
}

std::string help_text(const std::string& topic) {
    if (topic.empty()) return topic_list();
    if (const MethodDescription* const method = find_method(topic))
        return method_help(*method, "--param") + indirect_help(topic);
    if (const std::string text = indirect_help(topic); !text.empty()) return text.substr(1);
    for (const FileTopic& each : file_topics)
        if (topic == each.name) return each.text();
    return {};
}

}  // namespace caustics::experiments
