#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace caustics::experiments {

/// The shortest decimal text that reads back as the same number, independent of the locale.
/// NaN and infinities have no place in a table: throws std::logic_error.
std::string shortest(double value);
std::string shortest(float value);

/// A cell, quoted where its text needs it (RFC 4180).
std::string csv_cell(const std::string& text);
std::string csv_line(const std::vector<std::string>& cells);
/// Takes the first line of a CSV text (RFC 4180) off it: its cells.
std::vector<std::string> take_csv_line(std::string_view& text);

/// A table of numbers with named columns, as `probe` reads it.
struct NumberTable {
    std::vector<std::string> header;
    std::vector<std::vector<double>> rows;
    std::vector<std::string> lines;  ///< the rows as they were written

    /// Index of a column; header.size() when there is none.
    std::size_t column(const std::string& name) const;
};

/// Reads a CSV file, or what read_input() takes, strictly: every column is one of `required` or `optional`,
/// in any order, each at most once; every row has a finite number in every column. Throws InputError naming
/// the file and the row (the first one after the header is row 1).
NumberTable read_numbers(const std::filesystem::path& file,
                         const std::vector<std::string>& required,
                         const std::vector<std::string>& optional);

}  // namespace caustics::experiments
