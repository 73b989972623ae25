#pragma once

#include <string>
#include <utility>
#include <vector>

namespace caustics {

/// What help says of a key: of a method's parameter, a scene file or a sweep file.
struct KeyText {
    std::string key;
    std::string meaning;       ///< one sentence
    std::string unit = {};     ///< empty: a pure number, or none
    std::string source = {};   ///< paper and equation, as "[J96 (4)]"; empty: our own
    std::string type = {};     ///< "number", "whole number", "choice", ...
    std::string usual = {};    ///< the default; empty: the key must be given
    std::string choices = {};  ///< range or words; empty: any
};

/// The rows of two tables, one after the other.
template <class Row>
std::vector<Row> joined(std::vector<Row> first, std::vector<Row> second) {
    for (Row& row : second) first.push_back(std::move(row));
    return first;
}

/// The keys of one kind of object of a file.
struct ObjectText {
    std::string name;     ///< its `type`, or what it is where it has none
    std::string meaning;  ///< what it is and where it stands, one sentence
    std::vector<KeyText> keys;
};

/// The `type` of a kind that has a text. Made once: a scene may hold a million objects.
template <class Kind>
const std::string& name_of() {
    static const std::string name = Kind::text().name;
    return name;
}

}  // namespace caustics
