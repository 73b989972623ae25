#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/key_text.h"
#include "core/light_path/bounce_limit.h"
#include "core/scene_file/json_reader.h"

namespace caustics {

/// A parameter's value as records hold it.
using ParameterValue = std::variant<bool, std::int64_t, double, std::string>;

/// As people write it: "16", "0.5", "true", "hybrid".
std::string value_text(const ParameterValue& value);
/// "1 to 1000000".
std::string range_text(std::int64_t low, std::int64_t high);
std::string range_text(double low, double high);

/// A length above 0 whose square is one too, for floats. `otherwise` says what to do instead of giving it.
double read_length(const JsonNode& node, const std::string& otherwise);
/// A file, whose relative name starts at the folder of the file that names it.
std::filesystem::path read_file_name(const JsonNode& node);

/// A row of a method's table of parameters: how one key is read, described and recorded.
template <class Params>
struct Parameter {
    KeyText text;
    std::function<void(const JsonNode&, Params&)> read;  ///< the value, where it is given
    /// The value in force; nothing where the parameter has no effect.
    std::function<std::optional<ParameterValue>(const Params&)> value;
    /// Of a file that the method reads, if one is named: stands for the file's content.
    std::function<std::optional<std::uint64_t>(const Params&)> checksum = {};
    bool is_written_file = false;

    /// The same, without effect where `holds` says no.
    Parameter only_if(bool (*holds)(const Params&)) && {
        value = [all = std::move(value), holds](const Params& params) {
            return holds(params) ? all(params) : std::nullopt;
        };
        return std::move(*this);
    }
    /// The same, with these words for the default in place of its value.
    Parameter usually(std::string words) && {
        text.usual = std::move(words);
        return std::move(*this);
    }
};

/// What a pointer to a member of a params struct, or of its base, points to.
template <class Params, class Member>
using MemberOf = std::remove_cvref_t<std::invoke_result_t<Member, Params&>>;

/// Makers of rows, by what a member holds.
namespace parameter {

/// A row for a whole number; `member` is a pointer to it.
template <class Params, class Member>
Parameter<Params> whole_number(Member member, std::int64_t low, std::int64_t high, KeyText text) {
    using Value = MemberOf<Params, Member>;
    text.type = "whole number";
    text.choices = range_text(low, high);
    const auto value = [member](const Params& p) -> std::optional<ParameterValue> {
        return static_cast<std::int64_t>(std::invoke(member, p));
    };
    text.usual = value_text(*value(Params{}));
    return {std::move(text),
            [=](const JsonNode& node, Params& p) {
                std::invoke(member, p) = static_cast<Value>(node.as_integer_in(low, high));
            },
            value};
}

template <class Params, class Member>
Parameter<Params> number(Member member, double low, double high, KeyText text) {
    text.type = "number";
    text.choices = range_text(low, high);
    const auto value = [member](const Params& p) -> std::optional<ParameterValue> {
        return std::invoke(member, p);
    };
    text.usual = value_text(*value(Params{}));
    return {std::move(text),
            [=](const JsonNode& node, Params& p) {
                std::invoke(member, p) = node.as_number_in(low, high);
            },
            value};
}

/// A length that may be left out, and then is 0. `otherwise` says what happens then: "leave it out to ...".
template <class Params, class Member>
Parameter<Params> optional_length(Member member, std::string otherwise, KeyText text) {
    using Value = MemberOf<Params, Member>;
    // Moved: g++ 12 warns of a copy that it takes for endless.
    text.type = std::string("number");
    text.choices = std::string("above 0");
    text.unit = std::string("m");
    return {std::move(text),
            [member, otherwise = std::move(otherwise)](const JsonNode& node, Params& p) {
                std::invoke(member, p) = static_cast<Value>(read_length(node, otherwise));
            },
            [member](const Params& p) -> std::optional<ParameterValue> {
                const auto length = static_cast<double>(std::invoke(member, p));
                return length > 0 ? std::optional<ParameterValue>(length) : std::nullopt;
            }};
}

template <class Params>
Parameter<Params> yes_or_no(bool Params::* member, KeyText text) {
    text.type = "true or false";
    text.usual = value_text(Params{}.*member);
    return {std::move(text),
            [member](const JsonNode& node, Params& p) { p.*member = node.as_bool(); },
            [member](const Params& p) -> std::optional<ParameterValue> { return p.*member; }};
}

/// A word and what it stands for.
template <class Value>
struct Choice {
    std::string word;
    Value value;
    std::string recorded =
        {};  ///< an older word, read as well, that records and ids keep; empty: the word
};

template <class Params, class Member>
Parameter<Params> choice(Member member, std::vector<Choice<MemberOf<Params, Member>>> choices,
                         KeyText text) {
    text.type = "choice";
    std::vector<std::string> words, recorded;
    for (const auto& each : choices) {
        words.push_back(each.word);
        recorded.push_back(each.recorded.empty() ? each.word : each.recorded);
        text.choices += (text.choices.empty() ? "" : ", ") + each.word;
        if (each.value == std::invoke(member, Params{})) text.usual = each.word;
    }
    const auto value = [=](const Params& p) -> std::optional<ParameterValue> {
        for (std::size_t i = 0; i < choices.size(); ++i)
            if (choices[i].value == std::invoke(member, p)) return recorded[i];
        return {};
    };
    std::vector<std::string> known = words;
    if (recorded != words) known.insert(known.end(), recorded.begin(), recorded.end());
    return {std::move(text),
            [=](const JsonNode& node, Params& p) {
                std::invoke(member, p) = choices[node.as_choice(known) % choices.size()].value;
            },
            value};
}

/// Settings that have a name, such as those of a paper.
template <class Params>
struct Preset {
    std::string name;
    Params (*settings)();
};

/// A row that puts named settings in place of the defaults: the table's first, so that the rows below it
/// change what they say. `member` is the name in force; empty: none.
template <class Params>
Parameter<Params> preset(std::string Params::* member, std::vector<Preset<Params>> presets,
                         KeyText text) {
    text.type = "choice";
    text.usual = "none";
    std::vector<std::string> names;
    for (const auto& each : presets) {
        names.push_back(each.name);
        text.choices += (text.choices.empty() ? "" : ", ") + each.name;
    }
    return {std::move(text),
            [=](const JsonNode& node, Params& p) {
                const std::size_t chosen = node.as_choice(names);
                p = presets[chosen].settings();
                p.*member = names[chosen];
            },
            [member](const Params& p) -> std::optional<ParameterValue> {
                return (p.*member).empty() ? std::nullopt
                                           : std::optional<ParameterValue>(p.*member);
            }};
}

/// A file that the method writes, or none.
template <class Params>
Parameter<Params> written_file(std::filesystem::path Params::* member, KeyText text) {
    text.type = "file";
    text.usual = "none";
    Parameter<Params> row{
        std::move(text),
        [member](const JsonNode& node, Params& p) { p.*member = read_file_name(node); },
        [member](const Params& p) -> std::optional<ParameterValue> {
            return (p.*member).empty() ? std::nullopt
                                       : std::optional<ParameterValue>((p.*member).string());
        }};
    row.is_written_file = true;
    return row;
}

/// A file that the method reads, or none, and what stands for its content.
template <class Params>
Parameter<Params> read_file(std::filesystem::path Params::* member,
                            std::uint64_t (*checksum)(const std::filesystem::path&), KeyText text) {
    Parameter<Params> row = written_file(member, std::move(text));
    row.is_written_file = false;
    row.checksum = [member, checksum](const Params& p) -> std::optional<std::uint64_t> {
        return (p.*member).empty() ? std::nullopt : std::optional(checksum(p.*member));
    };
    return row;
}

/// The limit that all methods share.
template <class Params>
Parameter<Params> max_bounces() {
    return whole_number<Params>(
        &Params::max_bounces, 1, most_bounces,
        {.key = "max_bounces",
         .meaning = "Most specular events between light and receiver. Few cut the light of gems."});
}

/// The receiver at which a light path of an indirect method ends.
template <class Params>
Parameter<Params> diffuse_bounces() {
    return whole_number<Params>(
        &Params::diffuse_bounces, 0, 100'000,
        {.key = "diffuse_bounces",
         .meaning =
             "The receiver at which light paths end, counted from the light; 0: by roulette.",
         .source = "[C11]"});
}

}  // namespace parameter

}  // namespace caustics
