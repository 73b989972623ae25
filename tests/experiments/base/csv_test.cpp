#include "experiments/base/csv.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "core/base/error.h"
#include "experiments/base/file_io.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

TEST(Numbers, AreWrittenShortAndExact) {
    EXPECT_EQ(shortest(0.1), "0.1");
    EXPECT_EQ(shortest(0.1F), "0.1");
    EXPECT_EQ(shortest(1.0 / 3), "0.3333333333333333");
    EXPECT_EQ(shortest(-2.0), "-2");
    EXPECT_THROW(shortest(std::numeric_limits<double>::quiet_NaN()), std::logic_error);
    EXPECT_THROW(shortest(std::numeric_limits<float>::infinity()), std::logic_error);
}

TEST(Cells, AreQuotedWhereTheyMustBe) {
    EXPECT_EQ(csv_line({"a", "b,c", "d\"e", ""}), "a,\"b,c\",\"d\"\"e\",\n");
}

TEST(Cells, AreReadAsTheyWereWritten) {
    const std::vector<std::string> first = {"a", "b,c", "d\"e\"", "", "\"", "two\nlines"};
    const std::vector<std::string> second = {""};
    const std::string written = csv_line(first) + csv_line(second) + "x,y";
    std::string_view text = written;
    EXPECT_EQ(take_csv_line(text), first);
    EXPECT_EQ(take_csv_line(text), second);
    EXPECT_EQ(take_csv_line(text), (std::vector<std::string>{"x", "y"})) << "without an end";
    EXPECT_TRUE(text.empty());
}

class NumberTables : public testing::Test {
protected:
    NumberTable read(const std::string& text) {
        write_atomic_file(folder_ / "t.csv", text);
        return read_numbers(folder_ / "t.csv", {"x", "y"}, {"radius"});
    }
    std::string error(const std::string& text) {
        try {
            read(text);
        } catch (const InputError& error) {
            const std::string message = error.what();
            return message.substr(message.find("t.csv"));
        }
        return "no error";
    }
    support::TemporaryFolder folder_;
};

TEST_F(NumberTables, TakeTheirColumnsInAnyOrder) {
    const NumberTable table = read("y, radius,x\r\n2,0.5,+1\r\n4,1e-1,3\r\n");
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(table.rows[0][table.column("x")], 1);
    EXPECT_EQ(table.rows[1][table.column("radius")], 0.1);
    EXPECT_EQ(table.lines[1], "4,1e-1,3");
    EXPECT_EQ(table.column("z"), table.header.size());
}

TEST_F(NumberTables, AreReadAsOtherProgramsWriteThem) {
    EXPECT_EQ(read("x,y\n1.5D-1,+2d+1\n").rows[0], (std::vector<double>{0.15, 20}));
    EXPECT_EQ(error("x,y\n+-1,2\n"), "t.csv: row 1: x is \"+-1\", not a number");
    EXPECT_EQ(error("x,y\n1D,2\n"), "t.csv: row 1: x is \"1D\", not a number");
}

TEST_F(NumberTables, MayBeginWithAByteOrderMark) {
    EXPECT_EQ(read("\xEF\xBB\xBFx,y\n1,2\n").rows[0][1], 2);
}

TEST_F(NumberTables, NameWhatIsWrong) {
    EXPECT_EQ(error("x,y,z\n1,2,3\n"), "t.csv: unknown column \"z\" (known: x, y, radius)");
    EXPECT_EQ(error("x\n1\n"), "t.csv: column \"y\" is missing (needed: x, y)");
    EXPECT_EQ(error("x,y,x\n1,2,3\n"), "t.csv: column \"x\" stands twice");
    EXPECT_EQ(error("x,y\n1,2\n1\n"), "t.csv: row 2: 1 values for 2 columns");
    EXPECT_EQ(error("x,y\n1,nan\n"), "t.csv: row 1: y is nan, not a finite number");
    EXPECT_EQ(error("x,y\n1,2m\n"), "t.csv: row 1: y is \"2m\", not a number");
    EXPECT_EQ(error("x,y\n1,\n"), "t.csv: row 1: y is \"\", not a number");
    EXPECT_EQ(error(""), "t.csv: empty, a header is needed (x,y)");
    EXPECT_THROW(read_numbers(folder_ / "absent.csv", {"x"}, {}), InputError);
}

}  // namespace
}  // namespace caustics::experiments
