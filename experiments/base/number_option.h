#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "core/base/decimal.h"

namespace caustics::experiments {

/// The number that an option was given as. Throws InputError naming the option unless it is a
/// decimal(), or for a whole number a suffixed_count(), from `low` to `high`.
template <typename Number>
Number number_in(const std::string& option, const std::string& text, Number low, Number high);
extern template double number_in(const std::string&, const std::string&, double, double);
extern template int number_in(const std::string&, const std::string&, int, int);
extern template std::uint64_t number_in(const std::string&, const std::string&, std::uint64_t,
                                        std::uint64_t);

/// The one way to take a number from the command line, into a number or an optional one: the
/// parser's own conversion takes -1 for 2^64 - 1, 010 for 8, "" for 0 and nan for a number in range.
template <typename Number, typename Value>
CLI::Option* add_number(CLI::App& verb, const std::string& name, Value& value, Number low,
                        Number high, const std::string& help) {
    const std::string option = name.substr(name.find("--"));
    return verb
        .add_option_function<std::string>(
            name,
            [&value, option, low, high](const std::string& text) {
                value = number_in<Number>(option, text, low, high);
            },
            help)
        ->type_name("NUMBER");
}

}  // namespace caustics::experiments
