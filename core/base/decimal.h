#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace caustics {

/// A whole number or a finite number in decimal, as sweep files write it, or with nothing before or after its
/// point (".5", "5."): no "010", "0x10", "nan", "inf" or "1e400", nothing before or after. Empty where the text
/// is no such number, or the type cannot hold it.
template <typename Number>
std::optional<Number> decimal(const std::string& text);
extern template std::optional<double> decimal(const std::string&);
extern template std::optional<int> decimal(const std::string&);
extern template std::optional<std::uint64_t> decimal(const std::string&);

/// A whole number with a letter for its power of ten: "100k" or "100K" (10^3), "1.5M" (10^6), "2G" (10^9). Empty
/// for any other text, also without a letter, and beyond 2^53.
std::optional<std::int64_t> suffixed_count(const std::string& text);

/// A number as other programs write it into files: also with a plus sign before it ("+1"), with Fortran's letter for
/// its exponent ("1.0D-1"), and "nan" and "inf". Empty for any other text.
std::optional<double> foreign_number(std::string_view text);

}  // namespace caustics
