#include "core/base/decimal.h"

#include <charconv>
#include <cmath>
#include <string_view>
#include <type_traits>

namespace caustics {

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

template std::optional<double> decimal(const std::string&);
template std::optional<int> decimal(const std::string&);
template std::optional<std::uint64_t> decimal(const std::string&);

}  // namespace caustics
