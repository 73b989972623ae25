#include "experiments/report/table_row.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace caustics::experiments {

TableRow::TableRow(const std::vector<std::string>& columns, std::vector<std::string> cells)
    : columns_(columns), cells_(std::move(cells)) {
    if (cells_.size() != columns_.size())
        throw std::logic_error(
            fmt::format("a row of {} cells under {} columns", cells_.size(), columns_.size()));
}

const std::string& TableRow::text(std::string_view column) const {
    const auto found = std::ranges::find(columns_, column);
    if (found == columns_.end()) throw std::logic_error(fmt::format("no column {}", column));
    return cells_[static_cast<std::size_t>(found - columns_.begin())];
}

std::optional<double> TableRow::number(std::string_view column) const {
    const std::string& cell = text(column);
    double value = 0;
    const char* const end = cell.data() + cell.size();
    const auto result = std::from_chars(cell.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end) return {};
    return value;
}

}  // namespace caustics::experiments
