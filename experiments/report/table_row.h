#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace caustics::experiments {

/// A row of records.csv: texts under its columns, empty where a column does not apply.
class TableRow {
public:
    /// The columns must outlive the row.
    TableRow(const std::vector<std::string>& columns, std::vector<std::string> cells);

    /// Throws std::logic_error when there is no such column.
    const std::string& text(std::string_view column) const;
    /// Empty where the column does not apply or holds no number.
    std::optional<double> number(std::string_view column) const;

private:
    const std::vector<std::string>& columns_;
    std::vector<std::string> cells_;
};

}  // namespace caustics::experiments
