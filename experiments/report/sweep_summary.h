#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/report/table_row.h"

namespace caustics::experiments {

/// What the table of a sweep has to say in some lines, gathered one row at a time.
class SweepSummary {
public:
    /// `swept`: the keys by which trials differ.
    explicit SweepSummary(const std::vector<std::string>& swept);

    void add(const TableRow& row);

    /// The lines; `ran` of the `planned` trials ran now, in so many seconds.
    std::string text(std::size_t planned, std::size_t ran, double seconds) const;

private:
    struct Range {
        double low = std::numeric_limits<double>::infinity();
        double high = -std::numeric_limits<double>::infinity();
        void take_in(std::optional<double> value);
        bool is_empty() const { return low > high; }
        std::string text() const;
    };
    using Values = std::map<std::string, std::string>;  ///< of swept columns, where they apply
    struct Best {
        double rmse = std::numeric_limits<double>::infinity();
        std::string method;
        Values values;
    };
    /// A scene as it was set, which is what has one reference, and one share of pixels that are not counted: errors of two are
    /// not comparable.
    struct Judged {
        Best best;
        Values common;  ///< what all its rows have in common
    };
    Values values_of(const TableRow& row) const;
    std::string words(const Values& values) const;
    std::string statuses_text() const;
    std::string errors_text() const;
    std::string best_text() const;
    std::string best_line(const std::string& scene, const Judged& judged) const;

    std::vector<std::string> swept_;  ///< columns
    std::map<std::string, std::size_t> statuses_;
    std::map<std::string, std::map<std::string, Judged>>
        scenes_;  ///< by name, then reference and share
    Range energy_;
    Range seconds_;
    Range memory_;
    Range reference_error_;
};

}  // namespace caustics::experiments
