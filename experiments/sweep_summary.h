#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/table_row.h"

namespace caustics {

/// What the table of a sweep has to say in five lines, gathered one row at a time.
class SweepSummary {
public:
    /// `swept`: the columns by which trials are told apart.
    explicit SweepSummary(const std::vector<std::string>& swept) : swept_(swept) {}

    void add(const TableRow& row);

    /// The five lines; `ran` of the `planned` trials ran now, in so many seconds.
    std::string text(std::size_t planned, std::size_t ran, double seconds) const;

private:
    struct Range {
        double low = std::numeric_limits<double>::infinity();
        double high = -std::numeric_limits<double>::infinity();
        void take_in(std::optional<double> value);
        std::string text() const;
    };
    struct Best {
        double rmse = std::numeric_limits<double>::infinity();
        std::string words;  ///< "photonmap, nearest 50, photons 10000"
    };
    std::string words_of(const TableRow& row) const;
    std::string statuses_text() const;
    std::string best_text() const;

    std::vector<std::string> swept_;
    std::map<std::string, std::size_t> statuses_;
    std::map<std::string, Best> best_of_scene_;
    Range energy_;
    Range seconds_;
    Range memory_;
    Range reference_error_;
};

}  // namespace caustics
