#include "experiments/base/number_option.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"
#include "experiments/cli/verbs.h"

namespace caustics::experiments {
namespace {

/// What the verb says of an option given as `text`: InputError's message, or nothing. That other
/// things are missing is the parser's own complaint.
std::string refusal_of_option(const std::string& verb, const std::string& option,
                              const std::string& text) {
    CLI::App app;
    const std::vector<Verb> verbs = add_verbs(app);
    try {
        app.parse(std::vector<std::string>{option + "=" + text, verb});  // read from the back
    } catch (const InputError& error) {
        return error.what();
    } catch (const CLI::RequiredError&) {
        return {};
    } catch (const CLI::ParseError& error) {
        return std::string("not read: ") + error.what();
    }
    return {};
}

struct Option {
    std::string verb, name, type;
};

std::vector<Option> options_with_values() {
    CLI::App app;
    std::vector<Option> options;
    for (const Verb& verb : add_verbs(app))
        for (const CLI::Option* option : verb.app->get_options())
            if (option->get_items_expected() > 0 && !option->get_positional())
                options.push_back(
                    {verb.app->get_name(), option->get_name(), option->get_type_name()});
    return options;
}

TEST(NumberOptions, RefuseWhatIsNoDecimalNumberOfTheirRange) {
    std::size_t count = 0;
    for (const Option& option : options_with_values()) {
        if (option.type != "NUMBER") continue;
        ++count;
        const bool is_range_open = option.name == "--exposure";  // which takes a negative number
        for (const std::string text : {"nan", "inf", "-inf", "-1", "010", "0x10", "1e400", "1 ",
                                       "99999999999999999999", "1'000", "1_000", "1,5", "x"}) {
            const std::string message = refusal_of_option(option.verb, option.name, text);
            if (text == "-1" && is_range_open) {
                EXPECT_EQ(message, "") << option.verb << " " << option.name;
                continue;
            }
            EXPECT_EQ(message.rfind(option.name + " \"" + text + "\": expected a ", 0), 0U)
                << option.verb << ": " << message;
        }
        EXPECT_EQ(refusal_of_option(option.verb, option.name, "1"), "")
            << option.verb << option.name;
    }
    EXPECT_GE(count, 14U) << "a numeric option is not looked at";
}

TEST(NumberOptions, ReadWholeNumbersWithALetterForThousands) {
    EXPECT_EQ(number_in("--spp", "1k", 1, 1'000'000), 1000);
    EXPECT_EQ(number_in<std::uint64_t>("--seed", "1.5M", 0, ~std::uint64_t{0}), 1'500'000U);
    EXPECT_THROW(number_in("--spp", "2M", 1, 1'000'000), InputError);
    EXPECT_THROW(number_in("--spp", "9G", 1, 2147483647), InputError) << "no int";
    EXPECT_THROW(number_in<std::uint64_t>("--seed", "-1k", 0, 10'000), InputError);
    EXPECT_THROW(number_in("--seconds", "1k", 0.0, 1e6), InputError) << "no count";
    EXPECT_NE(refusal_of_option("sweep", "--memory", "4M"), "") << "a number of MiB, no count";
    EXPECT_EQ(refusal_of_option("render", "--spp", "4k"), "");
}

TEST(NumberOptions, RefuseAnEmptyText) {
    EXPECT_THROW(number_in("--seed", "", 0, 9), InputError);
    EXPECT_THROW(number_in("--dot", "", 0.0, 9.0), InputError);
}

/// The parser's own numbers take nan, 010 and -1 as they like.
TEST(NumberOptions, AreTakenByOneMechanism) {
    for (const Option& option : options_with_values())
        for (const std::string type : {"INT", "UINT", "FLOAT"})
            EXPECT_FALSE(option.type.starts_with(type))
                << option.verb << " " << option.name << ": use add_number";
}

TEST(Decimal, HoldsTheWholeRangeOfItsType) {
    EXPECT_EQ(decimal<std::uint64_t>("18446744073709551615"), ~std::uint64_t{0});
    EXPECT_FALSE(decimal<std::uint64_t>("18446744073709551616"));
    EXPECT_EQ(decimal<int>("-2147483648"), -2147483647 - 1);
    EXPECT_EQ(decimal<int>("0"), 0);
    EXPECT_EQ(decimal<double>("-0.5"), -0.5);
    EXPECT_EQ(decimal<double>("1e-3"), 0.001);
    EXPECT_FALSE(decimal<double>("-01"));
    EXPECT_EQ(decimal<double>(".15"), 0.15);
    EXPECT_EQ(decimal<double>("-.5"), -0.5);
    EXPECT_EQ(decimal<double>("2."), 2);
    for (const std::string text : {".", "-", "-.", "+.5", "1.5.2", ".e3", "00.5", " .5", ".5x"})
        EXPECT_FALSE(decimal<double>(text)) << text;
}

}  // namespace
}  // namespace caustics::experiments
