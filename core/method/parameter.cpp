#include "core/method/parameter.h"

#include <fmt/format.h>

#include <cmath>

namespace caustics {

namespace {

struct Shown {
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
    std::string operator()(double value) const { return fmt::format("{}", value); }
    std::string operator()(const std::string& value) const { return value; }
};

}  // namespace

std::string value_text(const ParameterValue& value) { return std::visit(Shown{}, value); }

std::string range_text(std::int64_t low, std::int64_t high) {
    return fmt::format("{} to {}", low, high);
}

std::string range_text(double low, double high) { return fmt::format("{} to {}", low, high); }

double read_length(const JsonNode& node, const std::string& otherwise) {
    const double value = node.as_number();
    const auto stored = static_cast<float>(value);
    // The square must be a float above 0 too: that is what distances are compared with.
    if (!(stored > 0 && stored * stored > 0) || !std::isfinite(stored * stored))
        node.fail("must be a length above 0 [m], 4e-23 to 1.8e19 (" + otherwise + ")");
    return value;
}

std::filesystem::path read_file_name(const JsonNode& node) {
    const std::string name = node.as_string();
    if (name.empty()) node.fail("must name a file");
    return (node.file().parent_path() / name).lexically_normal();
}

}  // namespace caustics
