#include "experiments/base/number_option.h"

#include <fmt/format.h>

#include <optional>
#include <type_traits>

#include "core/base/error.h"

namespace caustics::experiments {

template <typename Number>
Number number_in(const std::string& option, const std::string& text, Number low, Number high) {
    const std::optional<Number> value = decimal<Number>(text);
    if (value && *value >= low && *value <= high) return *value;
    throw InputError(fmt::format("{} \"{}\": expected a {}number from {} to {}, in decimal", option,
                                 text, std::is_integral_v<Number> ? "whole " : "", low, high));
}

template double number_in(const std::string&, const std::string&, double, double);
template int number_in(const std::string&, const std::string&, int, int);
template std::uint64_t number_in(const std::string&, const std::string&, std::uint64_t,
                                 std::uint64_t);

}  // namespace caustics::experiments
