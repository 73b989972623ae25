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

std::optional<std::int64_t> suffixed_count(const std::string& text) {
    constexpr std::string_view letters = "kKMG";
    constexpr const char* powers[] = {"e3", "e3", "e6", "e9"};
    const std::size_t letter = text.empty() ? std::string::npos : letters.find(text.back());
    if (letter == std::string::npos || text.find_first_of("eE") != std::string::npos) return {};
    // One numeral, so that 1.1M is 1,100,000 and not the rounded product of 1.1 and 10^6.
    const auto value = decimal<double>(text.substr(0, text.size() - 1) + powers[letter]);
    constexpr double exact_integers = 9007199254740992.0;
    if (!value || std::trunc(*value) != *value || std::abs(*value) > exact_integers) return {};
    return static_cast<std::int64_t>(*value);
}

std::optional<double> foreign_number(std::string_view text) {
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) return {};
    if (stop == text.data() + text.size()) return value;
    if (*stop != 'd' && *stop != 'D') return {};
    std::string with_e(text);
    with_e[static_cast<std::size_t>(stop - text.data())] = 'e';
    const auto again = std::from_chars(with_e.data(), with_e.data() + with_e.size(), value);
    if (again.ec != std::errc() || again.ptr != with_e.data() + with_e.size()) return {};
    return value;
}

}  // namespace caustics
