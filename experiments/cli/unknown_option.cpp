#include "experiments/cli/unknown_option.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/decimal.h"
#include "core/base/error.h"
#include "core/base/near_words.h"
#include "experiments/run/methods.h"

namespace caustics::experiments {

namespace {

/// A parameter as an option of its own name, which users of other programs write.
struct ParameterOption {
    std::string name;    ///< "--photons"
    std::string setter;  ///< "--param photons"
    std::string method;  ///< the first that has it
};

template <class Methods>
void append_parameters(const Methods& methods, const std::string& option,
                       std::vector<ParameterOption>& all) {
    for (const auto* method : methods)
        for (const KeyText& key : method->parameters())
            all.push_back({"--" + key.key, option + " " + key.key, method->facts().name});
}

std::vector<ParameterOption> parameter_options() {
    std::vector<ParameterOption> all;
    append_parameters(all_methods(), "--param", all);
    append_parameters(all_indirect_methods(), "--indirect-param", all);
    return all;
}

std::vector<std::string> option_names(const CLI::App& verb) {
    std::vector<std::string> names;
    for (const CLI::Option* option : verb.get_options())
        if (!option->get_positional()) names.push_back(option->get_name(false, true));
    return names;
}

/// The long ones, without the short ones beside them: "-o,--output" as "--output".
std::vector<std::string> long_names(const CLI::App& verb) {
    std::vector<std::string> names;
    for (const CLI::Option* option : verb.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

/// The value that the user gave the option, or a word that stands for it.
std::string given_value(const std::vector<std::string>& words, std::size_t place) {
    const std::size_t equals = words[place].find('=');
    if (equals != std::string::npos) return words[place].substr(equals + 1);
    const bool has_next = place + 1 < words.size() && !words[place + 1].starts_with("--");
    return has_next ? words[place + 1] : "VALUE";
}

/// How the verb takes a parameter.
std::string assignment(const CLI::App& verb, const ParameterOption& parameter,
                       const std::string& value) {
    const std::string option = parameter.setter.substr(0, parameter.setter.find(' '));
    if (verb.get_option_no_throw(option) != nullptr)
        return fmt::format("{}={}", parameter.setter, value);
    if (verb.get_name() == "sweep")
        return fmt::format(R"("param": {{"{}": {}}} in the sweep file)", parameter.name.substr(2),
                           decimal<double>(value) ? value : "\"" + value + "\"");
    return fmt::format("{}={} of render", parameter.setter, value);
}

std::string advice(const CLI::App& verb, const std::string& name, const std::string& value) {
    const std::vector<ParameterOption> parameters = parameter_options();
    std::string spelt = name;
    std::ranges::replace(spelt.begin() + 2, spelt.end(), '-', '_');
    if (const auto same = std::ranges::find(parameters, spelt, &ParameterOption::name);
        same != parameters.end())
        return fmt::format(": {} is a parameter of {}, given as {}", spelt.substr(2), same->method,
                           assignment(verb, *same, value));
    std::vector<std::string> known = long_names(verb);
    for (const ParameterOption& parameter : parameters) known.push_back(parameter.name);
    std::string text;
    for (const std::string& near : near_words(name, known)) {
        const auto parameter = std::ranges::find(parameters, near, &ParameterOption::name);
        const bool is_option = verb.get_option_no_throw(near) != nullptr;
        text += (text.empty() ? ": did you mean " : " or ") +
                (is_option ? near : assignment(verb, *parameter, value));
    }
    return text.empty() ? "" : text + "?";
}

}  // namespace

void refuse_option(const CLI::App& verb, const std::vector<std::string>& words, std::size_t place) {
    const std::string name = words[place].substr(0, words[place].find('='));
    throw InputError(fmt::format("unknown option {}{} (known: {})", name,
                                 advice(verb, name, given_value(words, place)),
                                 fmt::join(option_names(verb), ", ")));
}

}  // namespace caustics::experiments
