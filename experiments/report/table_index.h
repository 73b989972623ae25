#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/report/cell_variance.h"

namespace caustics::experiments {

/// What the tables of a folder were made from: DIR/.table, which spares reading every record again.
/// It proves itself: tables by their checksums, records by their stamps. Without it nothing is lost
/// but time.
struct TableIndex {
    struct Row {
        std::string trial;
        std::string record;      ///< file_stamp() of the record it was made from, or empty
        std::size_t offset = 0;  ///< of its line in records.csv
    };
    std::vector<Row> rows;    ///< in the order of the tables
    CellVariances variances;  ///< of their cells
    bool complete = false;    ///< every row has its record, every cell its variance
    std::string csv;          ///< checksum of records.csv
    std::string jsonl;        ///< checksum of records.jsonl
};

void write_table_index(const TableIndex& index, const std::filesystem::path& folder);
/// Empty when there is none, or it cannot be read, or another version of the program wrote it.
TableIndex read_table_index(const std::filesystem::path& folder);

}  // namespace caustics::experiments
