#include "core/mesh/ply_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <set>
#include <sstream>
#include <string_view>

#include "core/base/decimal.h"
#include "core/base/error.h"
#include "core/mesh/quoted_word.h"

namespace caustics {

static_assert(std::endian::native == std::endian::little, "read_binary turns only big-endian data");

namespace {

std::optional<PlyType> parse_type(const std::string& word) {
    constexpr std::array<std::array<const char*, 2>, 8> names = {{{"char", "int8"},
                                                                  {"uchar", "uint8"},
                                                                  {"short", "int16"},
                                                                  {"ushort", "uint16"},
                                                                  {"int", "int32"},
                                                                  {"uint", "uint32"},
                                                                  {"float", "float32"},
                                                                  {"double", "float64"}}};
    for (std::size_t i = 0; i < names.size(); ++i)
        if (word == names[i][0] || word == names[i][1]) return static_cast<PlyType>(i);
    return {};
}

}  // namespace

void PlyFile::fail(const std::string& reason) const { throw InputError(name_ + ": " + reason); }

std::vector<PlyElement> PlyFile::read_header() {
    if (std::vector<std::string> magic = header_line(); magic != std::vector<std::string>{"ply"})
        fail("not a PLY file: the first line is not 'ply'");
    std::vector<PlyElement> elements;
    std::optional<PlyFormat> format;
    for (;;) {
        const std::vector<std::string> words = header_line();
        if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
        if (words[0] == "end_header") break;
        if (words[0] == "format" && format)
            fail("the header has more than one format line");
        else if (words[0] == "format")
            format = read_format(words);
        else if (words[0] == "element")
            elements.push_back(read_element(words));
        else if (words[0] == "property" && !elements.empty())
            elements.back().properties.push_back(read_property(words));
        else
            fail("header line beginning with " + quoted_word(words[0]) + " is not understood");
    }
    if (!format) fail("the header has no format line");
    for (const PlyElement& element : elements) require_distinct(element.properties);
    format_ = *format;
    return elements;
}

double PlyFile::read(PlyType type, const std::string& element, std::size_t index) {
    if (format_ == PlyFormat::ascii) return read_ascii(element, index);
    switch (type) {
        case PlyType::int8: return read_binary<std::int8_t>(element, index);
        case PlyType::uint8: return read_binary<std::uint8_t>(element, index);
        case PlyType::int16: return read_binary<std::int16_t>(element, index);
        case PlyType::uint16: return read_binary<std::uint16_t>(element, index);
        case PlyType::int32: return read_binary<std::int32_t>(element, index);
        case PlyType::uint32: return read_binary<std::uint32_t>(element, index);
        case PlyType::float32: return static_cast<double>(read_binary<float>(element, index));
        case PlyType::float64: break;
    }
    return read_binary<double>(element, index);
}

void PlyFile::expect_end() {
    if (format_ == PlyFormat::ascii) skip_space();
    if (at_ != bytes_.size())
        fail("the file goes on after the last element that its header declares");
}

std::vector<std::string> PlyFile::header_line() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string::npos) fail("the file ends inside the header");
    std::istringstream stream(bytes_.substr(at_, end - at_));
    at_ = end + 1;
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

PlyFormat PlyFile::read_format(const std::vector<std::string>& words) const {
    const std::array names = {"ascii", "binary_little_endian", "binary_big_endian"};
    const auto* const found = words.size() == 3 && words[2] == "1.0"
                                  ? std::find(names.begin(), names.end(), words[1])
                                  : names.end();
    if (found == names.end())
        fail("unknown format (known: ascii, binary_little_endian, binary_big_endian; all 1.0)");
    return static_cast<PlyFormat>(found - names.begin());
}

PlyElement PlyFile::read_element(const std::vector<std::string>& words) const {
    std::uint32_t count = 0;
    if (words.size() == 3) {
        const char* end = words[2].data() + words[2].size();
        const auto [stop, error] = std::from_chars(words[2].data(), end, count);
        if (error == std::errc{} && stop == end) return {words[1], count, {}};
    }
    fail("an element line needs a name and a count");
}

PlyProperty PlyFile::read_property(const std::vector<std::string>& words) const {
    const bool list = words.size() == 5 && words[1] == "list";
    if (!list && words.size() != 3) fail("a property line needs a type and a name");
    const std::optional<PlyType> type = parse_type(words[words.size() - 2]);
    const std::optional<PlyType> count_type = list ? parse_type(words[2]) : std::nullopt;
    if (!type || (list && !count_type))
        fail("property " + quoted_word(words.back()) + " has an unknown type");
    return {words.back(), *type, count_type};
}

// By order, as a header may have millions.
void PlyFile::require_distinct(const std::vector<PlyProperty>& properties) const {
    std::set<std::string_view> names;
    for (const PlyProperty& property : properties)
        if (!names.insert(property.name).second)
            fail("property " + quoted_word(property.name) + " is given twice");
}

void PlyFile::fail_truncated(const std::string& element, std::size_t index) const {
    fail("the file is truncated: it ends inside " + element + " " + std::to_string(index));
}

void PlyFile::skip_space() {
    at_ = std::min(bytes_.find_first_not_of(" \t\r\n\v\f", at_), bytes_.size());
}

double PlyFile::read_ascii(const std::string& element, std::size_t index) {
    skip_space();
    if (at_ == bytes_.size()) fail_truncated(element, index);
    const std::size_t end = std::min(bytes_.find_first_of(" \t\r\n\v\f", at_), bytes_.size());
    const std::string_view word(bytes_.data() + at_, end - at_);
    at_ = end;
    const std::optional<double> value = foreign_number(word);
    if (!value)
        fail(element + " " + std::to_string(index) + ": " + quoted_word(word) + " is not a number");
    return *value;
}

template <class Value>
Value PlyFile::read_binary(const std::string& element, std::size_t index) {
    std::array<char, sizeof(Value)> raw;
    if (bytes_.size() - at_ < raw.size()) fail_truncated(element, index);
    std::copy_n(bytes_.data() + at_, raw.size(), raw.data());
    at_ += raw.size();
    if (format_ == PlyFormat::big_endian) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<Value>(raw);
}

}  // namespace caustics
