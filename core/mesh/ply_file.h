#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace caustics {

enum class PlyFormat { ascii, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PlyProperty {
    std::string name;
    PlyType type;
    std::optional<PlyType> count_type;  ///< of a list
};

struct PlyElement {
    std::string name;
    std::size_t count;
    std::vector<PlyProperty> properties;
};

/// Reads a PLY file's header and then its values, one after the other, and never past the end of
/// `bytes`, which must outlive it. Failures are InputErrors beginning with `name`.
class PlyFile {
public:
    PlyFile(const std::string& bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    std::vector<PlyElement> read_header();

    /// The next value of the data, converted from `type`; exact but for the digits of an ASCII
    /// number. `element` and `index` name it when it is missing or misspelt.
    double read(PlyType type, const std::string& element, std::size_t index);

    bool is_binary() const { return format_ != PlyFormat::ascii; }

    /// Fails when anything but white space (ASCII) is left.
    void expect_end();

    [[noreturn]] void fail(const std::string& reason) const;

private:
    std::vector<std::string> header_line();
    PlyFormat read_format(const std::vector<std::string>& words) const;
    PlyElement read_element(const std::vector<std::string>& words) const;
    PlyProperty read_property(const std::vector<std::string>& words) const;
    void require_distinct(const std::vector<PlyProperty>& properties) const;
    double read_ascii(const std::string& element, std::size_t index);
    template <class Value>
    Value read_binary(const std::string& element, std::size_t index);
    void skip_space();
    [[noreturn]] void fail_truncated(const std::string& element, std::size_t index) const;

    const std::string& bytes_;
    std::string name_;
    std::size_t at_ = 0;
    PlyFormat format_ = PlyFormat::ascii;
};

}  // namespace caustics
