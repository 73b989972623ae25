#pragma once

#include <span>

namespace caustics::experiments {

/// A column that every table of trials has.
struct RecordColumn {
    /// What its value is, where it is there and not null.
    enum class Kind { number, count, text, any };

    const char* name;
    const char* pointer;  ///< into record.json
    Kind kind;
    const char* unit;     ///< empty: none, or "1" for a ratio
    const char* meaning;  ///< as in results/records.md
};

/// In the order of the table.
std::span<const RecordColumn> record_columns_of_all();

}  // namespace caustics::experiments
