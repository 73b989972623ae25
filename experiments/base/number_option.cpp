#include "experiments/base/number_option.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string_view>
#include <type_traits>

#include "core/base/error.h"

namespace caustics::experiments {

namespace {

bool has_leading_zero(std::string_view text) {
    if (text.starts_with('-')) text.remove_prefix(1);
    return text.size() > 1 && text[0] == '0' && text[1] >= '0' && text[1] <= '9';
}

}  // namespace

template <typename Number>
std::optional<Number> decimal(const std::string& text) {
    Number value = 0;
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end || has_leading_zero(text)) return {};
    if constexpr (std::is_floating_point_v<Number>)
        if (!std::isfinite(value)) return {};
    return value;
}

template <typename Number>
Number number_in(const std::string& option, const std::string& text, Number low, Number high) {
    const std::optional<Number> value = decimal<Number>(text);
    if (value && *value >= low && *value <= high) return *value;
    throw InputError(fmt::format("{} \"{}\": expected a {}number from {} to {}, in decimal", option,
                                 text, std::is_integral_v<Number> ? "whole " : "", low, high));
}

template std::optional<double> decimal(const std::string&);
template std::optional<int> decimal(const std::string&);
template std::optional<std::uint64_t> decimal(const std::string&);
template double number_in(const std::string&, const std::string&, double, double);
template int number_in(const std::string&, const std::string&, int, int);
template std::uint64_t number_in(const std::string&, const std::string&, std::uint64_t,
                                 std::uint64_t);

}  // namespace caustics::experiments
