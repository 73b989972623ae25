#include "core/base/printable.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace caustics {
namespace {

TEST(OneLine, LeavesPlainTextAndUtf8AsTheyAre) {
    for (const std::string text : {"", "a.json: /x: expected a number",
                                   "Gr\xC3\xBC\xC3\x9F"
                                   "e \xE2\x82\xAC \xF0\x9F\x94\xA5"})
        EXPECT_EQ(one_line(text), text);
}

TEST(OneLine, ReplacesWhatATerminalWouldObey) {
    EXPECT_EQ(one_line("a\nb\tc\r\n"), "a b c");
    EXPECT_EQ(one_line(std::string_view("\x1b[2J\0\x7f|", 7)), "?[2J??|");
    EXPECT_EQ(one_line("\xC2\x9B"
                       "31m"),
              "?31m")
        << "C1 control";
    // Alone, too long for what it says, a surrogate, beyond Unicode, cut off.
    EXPECT_EQ(one_line("\x80 \xC0\xAF \xED\xA0\x80 \xF4\x90\x80\x80 \xE2\x82"), "? ?? ??? ???? ??");
}

TEST(OneLine, LeavesTheMiddleOutOfWhatIsLong) {
    const std::string word = one_line("<" + std::string(5000, 'x') + "> is unknown");
    EXPECT_EQ(word.size(), 250U + 3 + 250 + 11);
    EXPECT_TRUE(word.starts_with("<xxx"));
    EXPECT_TRUE(word.ends_with("x> is unknown"));
    std::string many;
    for (int i = 0; i < 5000; ++i) many += "\xC3\xBC ";
    const std::string line = one_line(many);
    EXPECT_LE(line.size(), 2003U);
    EXPECT_TRUE(is_utf8(line));
}

TEST(Errors, AreFitToPrint) {
    EXPECT_STREQ(InputError("a\x1b[31m\nb").what(), "a?[31m b");
    EXPECT_STREQ(UnsupportedScene("a\x1b[31m\nb").what(), "a?[31m b");
}

}  // namespace
}  // namespace caustics
