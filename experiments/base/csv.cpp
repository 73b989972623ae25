#include "experiments/base/csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "core/base/decimal.h"
#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "core/base/key_text.h"
#include "core/base/near_words.h"
#include "experiments/base/file_io.h"

namespace caustics::experiments {

namespace {

template <typename Number>
std::string shortest_text(Number value) {
    if (!std::isfinite(value)) throw std::logic_error("a number that is not finite in a table");
    std::array<char, 32> buffer{};
    const std::to_chars_result end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), end.ptr};
}

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> cells;
    std::size_t start = 0;
    while (true) {
        const std::size_t comma = line.find(',', start);
        cells.push_back(trimmed(line.substr(start, comma - start)));
        if (comma == std::string::npos) return cells;
        start = comma + 1;
    }
}

double number(const std::string& text, const std::string& place, const std::string& column) {
    const std::optional<double> value = foreign_number(text);
    if (!value)
        throw InputError(fmt::format("{}: {} is \"{}\", not a number", place, column, text));
    if (!std::isfinite(*value))
        throw InputError(fmt::format("{}: {} is {}, not a finite number", place, column, text));
    return *value;
}

void check_header(const std::string& file, const std::vector<std::string>& header,
                  const std::vector<std::string>& required,
                  const std::vector<std::string>& optional) {
    const std::vector<std::string> all = joined(required, optional);
    for (std::size_t i = 0; i < header.size(); ++i) {
        if (std::ranges::find(all, header[i]) == all.end())
            throw InputError(fmt::format("{}: unknown column \"{}\"{} (known: {})", file, header[i],
                                         did_you_mean(header[i], all), fmt::join(all, ", ")));
        if (std::find(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(i), header[i]) !=
            header.begin() + static_cast<std::ptrdiff_t>(i))
            throw InputError(fmt::format("{}: column \"{}\" stands twice", file, header[i]));
    }
    for (const std::string& name : required)
        if (std::ranges::count(header, name) == 0)
            throw InputError(fmt::format("{}: column \"{}\" is missing (needed: {})", file, name,
                                         fmt::join(required, ", ")));
}

}  // namespace

std::string shortest(double value) { return shortest_text(value); }
std::string shortest(float value) { return shortest_text(value); }

std::string csv_cell(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"') quoted += '"';
        quoted += c;
    }
    return quoted + '"';
}

std::string csv_line(const std::vector<std::string>& cells) {
    std::string line;
    for (const std::string& cell : cells) {
        if (&cell != cells.data()) line += ',';
        line += csv_cell(cell);
    }
    return line + '\n';
}

std::vector<std::string> take_csv_line(std::string_view& text) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    std::size_t i = 0;
    for (; i < text.size() && (quoted || text[i] != '\n'); ++i) {
        const bool doubled = quoted && text.substr(i, 2) == "\"\"";
        if (doubled) ++i;  // stands for one quote
        if (text[i] == '"' && !doubled)
            quoted = !quoted;
        else if (text[i] == ',' && !quoted)
            cells.emplace_back();
        else
            cells.back() += text[i];
    }
    text.remove_prefix(std::min(i + 1, text.size()));
    return cells;
}

std::size_t NumberTable::column(const std::string& name) const {
    return static_cast<std::size_t>(std::ranges::find(header, name) - header.begin());
}

NumberTable read_numbers(const std::filesystem::path& file,
                         const std::vector<std::string>& required,
                         const std::vector<std::string>& optional) {
    const std::string name = file == "-" ? "standard input" : file.string();
    std::istringstream in(read_input(file));
    NumberTable table;
    std::string line;
    if (!std::getline(in, line) || trimmed(line).empty())
        throw InputError(
            fmt::format("{}: empty, a header is needed ({})", name, fmt::join(required, ",")));
    // Spreadsheets begin UTF-8 with a byte order mark.
    if (line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    table.header = split(line);
    check_header(name, table.header, required, optional);
    constexpr std::size_t rows_between_looks = 1 << 12;  // for Ctrl-C
    while (std::getline(in, line)) {
        if (table.rows.size() % rows_between_looks == 0) throw_if_interrupted();
        if (trimmed(line).empty() && in.peek() == std::istringstream::traits_type::eof()) break;
        const std::string place = fmt::format("{}: row {}", name, table.rows.size() + 1);
        const std::vector<std::string> cells = split(line);
        if (cells.size() != table.header.size())
            throw InputError(fmt::format("{}: {} values for {} columns", place, cells.size(),
                                         table.header.size()));
        std::vector<double> row;
        for (std::size_t i = 0; i < cells.size(); ++i)
            row.push_back(number(cells[i], place, table.header[i]));
        table.rows.push_back(std::move(row));
        table.lines.push_back(trimmed(line));
    }
    return table;
}

}  // namespace caustics::experiments
