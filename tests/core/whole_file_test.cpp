#include "core/whole_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

std::string content(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::ptrdiff_t files_in(const std::filesystem::path& folder) {
    return std::distance(std::filesystem::directory_iterator(folder), {});
}

TEST(WholeFile, IsThereOnlyWhenItIsWhole) {
    const support::TemporaryFolder folder;
    const std::filesystem::path file = folder / "a.txt";
    write_whole_file(file, "old");
    {
        WholeFile out(file);
        out.write("new ");
        EXPECT_EQ(content(file), "old");
        out.write("text");
        out.commit();
    }
    EXPECT_EQ(content(file), "new text");
    {
        WholeFile out(file);
        out.write("never finished");
    }
    EXPECT_EQ(content(file), "new text");
    EXPECT_EQ(files_in(folder.path()), 1) << "nothing temporary is left";
}

std::string refusal(const std::filesystem::path& file, std::string_view bytes) {
    try {
        write_whole_file(file, bytes);
    } catch (const InputError& error) {
        return error.what();
    }
    return "written";
}

TEST(WholeFile, NamesTheFileAndTheReason) {
    const support::TemporaryFolder folder;
    const std::filesystem::path nowhere = folder / "absent" / "a.txt";
    EXPECT_EQ(refusal(nowhere, "x"),
              nowhere.string() + ": cannot be written (No such file or directory)");
    std::filesystem::create_directories(folder / "a_folder" / "in it");
    const std::string onto_folder = refusal(folder / "a_folder", "x");
    EXPECT_NE(onto_folder.find("a_folder: cannot be written ("), std::string::npos) << onto_folder;
    EXPECT_EQ(files_in(folder.path()), 1);
}

}  // namespace
}  // namespace caustics
