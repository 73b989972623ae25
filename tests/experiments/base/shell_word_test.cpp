#include "experiments/base/shell_word.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace caustics::experiments {
namespace {

/// What a shell makes of it.
std::string read_by_shell(const std::string& word) {
    std::FILE* const pipe = popen(("printf %s " + word).c_str(), "r");
    std::string text;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
    EXPECT_EQ(pclose(pipe), 0);
    return text;
}

TEST(ShellWord, IsReadBackOnOneLine) {
    for (const std::string text :
         {"plain-1.5_a/b=c", "", "a b", "it's", "$(touch a)", "`a`", "a;b", "~", "*", "#a", "\"",
          "\\n%s\\", "a\nb'c", "tab\t%d\\\x7f$(a)\nb", "\xc3\xa9"}) {
        const std::string word = shell_word(text);
        EXPECT_EQ(read_by_shell(word), text) << word;
        EXPECT_EQ(word.find('\n'), std::string::npos) << word;
    }
}

TEST(ShellWord, OfAFileIsNoOption) {
    EXPECT_EQ(shell_path("--force/scene.json"), "./--force/scene.json");
    EXPECT_EQ(shell_path("a/--force"), "a/--force");
}

}  // namespace
}  // namespace caustics::experiments
