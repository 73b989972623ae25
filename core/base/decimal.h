#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace caustics {

/// A whole number or a finite number in decimal, as sweep files write it, or with nothing before or after its
/// point (".5", "5."): no "010", "0x10", "nan", "inf" or "1e400", nothing before or after. Empty where the text
/// is no such number, or the type cannot hold it.
template <typename Number>
std::optional<Number> decimal(const std::string& text);
extern template std::optional<double> decimal(const std::string&);
extern template std::optional<int> decimal(const std::string&);
extern template std::optional<std::uint64_t> decimal(const std::string&);

}  // namespace caustics
