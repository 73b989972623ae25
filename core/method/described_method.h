#pragma once

#include <algorithm>
#include <cmath>

#include "core/method/method_description.h"

namespace caustics {

/// Takes about that share of a number, at least 1, and tells the share; 1 of none.
template <class Number>
double take_share_of(Number& number, double share) {
    if (number <= 0) return 1;
    const auto all = static_cast<double>(number);
    number = static_cast<Number>(std::max(1.0, std::round(share * all)));
    return static_cast<double>(number) / all;
}

/// A method described by a params struct with its defaults in place and a table of its members.
template <class Params, class Estimator = CausticEstimator>
struct MethodTable {
    MethodFacts facts;
    std::vector<Parameter<Params>> parameters = {};
    /// What holds between parameters, once those that are given are in place: throws InputError, or
    /// puts defaults in place that depend on others.
    void (*settle)(const JsonNode& node, Params& params) = [](const JsonNode&, Params&) {};
    void (*take_least_work)(Params& params) = [](Params&) {};
    /// Takes about that share of the work, and tells the share.
    double (*take_share)(Params& params, double share) = [](Params&, double) { return 1.0; };
    std::unique_ptr<const Estimator> (*make)(const Scene&, const Params&, const RunOptions&,
                                             int pass) =
        [](const Scene& scene, const Params& params, const RunOptions& options, int) {
            return build(scene, params, options);
        };
    /// Finds the number that the time grows with, where parameters choose another than the facts name.
    WorkParameter (*work)(const MethodFacts& of, const Params& params) =
        [](const MethodFacts& of, const Params&) { return of.work; };
    int Params::* passes = nullptr;
    double Params::* disc_radius = nullptr;
};

/// A method of such a table. Lives as long as what it configures.
template <class Params, class Estimator = CausticEstimator>
class DescribedMethod final : public MethodDescriptionOf<Estimator> {
public:
    explicit DescribedMethod(MethodTable<Params, Estimator> table) : table_(std::move(table)) {}

    const MethodFacts& facts() const override { return table_.facts; }

    std::vector<KeyText> parameters() const override {
        std::vector<KeyText> all;
        for (const auto& parameter : table_.parameters) all.push_back(parameter.text);
        return all;
    }

    std::shared_ptr<const ConfiguredMethodOf<Estimator>> configure(
        const JsonNode& node) const override {
        return std::make_shared<Configured>(table_, read(node));
    }

    Params read(const JsonNode& node) const {
        Params params;
        for (const auto& parameter : table_.parameters)
            if (const auto given = node.find(parameter.text.key)) parameter.read(*given, params);
        node.finish();
        table_.settle(node, params);
        return params;
    }

private:
    class Configured final : public ConfiguredMethodOf<Estimator> {
    public:
        Configured(const MethodTable<Params, Estimator>& table, Params params)
            : table_(table), params_(std::move(params)) {}

        std::vector<std::pair<std::string, ParameterValue>> values() const override {
            std::vector<std::pair<std::string, ParameterValue>> all;
            for (const auto& parameter : table_.parameters)
                if (auto value = parameter.value(params_))
                    all.emplace_back(parameter.text.key, std::move(*value));
            return all;
        }
        std::map<std::string, std::uint64_t> files_read() const override {
            std::map<std::string, std::uint64_t> all;
            for (const auto& parameter : table_.parameters)
                if (parameter.checksum)
                    if (const auto checksum = parameter.checksum(params_))
                        all[parameter.text.key] = *checksum;
            return all;
        }
        std::vector<std::string> files_written() const override {
            std::vector<std::string> all;
            for (const auto& parameter : table_.parameters)
                if (parameter.is_written_file && parameter.value(params_))
                    all.push_back(parameter.text.key);
            return all;
        }
        int pass_count() const override {
            return table_.passes == nullptr ? 1 : params_.*table_.passes;
        }
        WorkParameter work() const override { return table_.work(table_.facts, params_); }
        double disc_radius() const override {
            return table_.disc_radius == nullptr ? 0 : params_.*table_.disc_radius;
        }
        std::shared_ptr<const ConfiguredMethodOf<Estimator>> with_least_work() const override {
            Params least = params_;
            table_.take_least_work(least);
            return std::make_shared<Configured>(table_, std::move(least));
        }
        std::pair<std::shared_ptr<const ConfiguredMethodOf<Estimator>>, double> with_share_of_work(
            double share) const override {
            Params some = params_;
            const double taken = table_.take_share(some, share);
            return {std::make_shared<Configured>(table_, std::move(some)), taken};
        }
        std::unique_ptr<const Estimator> build(const Scene& scene, const RunOptions& options,
                                               int pass) const override {
            return table_.make(scene, params_, options, pass);
        }

    private:
        const MethodTable<Params, Estimator>& table_;
        Params params_;
    };

    MethodTable<Params, Estimator> table_;
};

}  // namespace caustics
