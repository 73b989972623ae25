#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace caustics {

/// What the records of a sweep have to say in five lines, gathered one record at a time.
class SweepSummary {
public:
    void add(const nlohmann::json& record);

    /// The five lines; `ran` of the `planned` trials ran now, in so many seconds.
    std::string text(std::size_t planned, std::size_t ran, double seconds) const;

private:
    struct Range {
        double low = std::numeric_limits<double>::infinity();
        double high = -std::numeric_limits<double>::infinity();
        std::string text() const;
    };
    struct Best {
        double rmse = std::numeric_limits<double>::infinity();
        std::string words;  ///< "photonmap, nearest 50, photons 10000"
    };
    void widen(Range& range, const nlohmann::json& record, const char* pointer) const;
    std::string statuses_text() const;
    std::string best_text() const;

    std::map<std::string, std::size_t> statuses_;
    std::map<std::string, Best> best_of_scene_;
    Range energy_;
    Range seconds_;
    Range memory_;
    Range reference_error_;
};

}  // namespace caustics
