#include "experiments/base/number_option.h"

#include <fmt/format.h>

#include <optional>
#include <type_traits>
#include <utility>

#include "core/base/error.h"

namespace caustics::experiments {

template <typename Number>
Number number_in(const std::string& option, const std::string& text, Number low, Number high) {
    constexpr bool is_whole = std::is_integral_v<Number>;
    std::optional<Number> value = decimal<Number>(text);
    if constexpr (is_whole)
        if (const auto count = suffixed_count(text); count && std::in_range<Number>(*count))
            value = static_cast<Number>(*count);
    if (value && *value >= low && *value <= high) return *value;
    throw InputError(fmt::format("{} \"{}\": expected a {}number from {} to {}, in decimal{}",
                                 option, text, is_whole ? "whole " : "", low, high,
                                 is_whole ? " (100k and 1.5M are read too)" : ""));
}

template double number_in(const std::string&, const std::string&, double, double);
template int number_in(const std::string&, const std::string&, int, int);
template std::uint64_t number_in(const std::string&, const std::string&, std::uint64_t,
                                 std::uint64_t);

}  // namespace caustics::experiments
