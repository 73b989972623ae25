#pragma once

#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/caustic_estimator.h"
#include "core/method/method_description.h"
#include "core/scene_file/json_reader.h"

namespace caustics::experiments {

/// A method with its parameters, as the harness passes it on; parse_method and parse_indirect make it.
template <class Estimator>
struct MethodOf {
    std::string name;
    const MethodDescriptionOf<Estimator>* description = nullptr;
    std::shared_ptr<const ConfiguredMethodOf<Estimator>> configured = {};

    const MethodFacts& facts() const { return description->facts(); }
};
using Method = MethodOf<CausticEstimator>;
/// Of the indirect layer.
using IndirectMethod = MethodOf<IndirectEstimator>;

/// The names of all_methods(), in its order.
const std::vector<std::string>& method_names();

/// Nothing where no method has that name.
const MethodDescription* find_method(const std::string& name);

/// The method of that name with its parameters read. Throws InputError listing the names, or from
/// the method's own table.
Method parse_method(const std::string& name, const JsonNode& params);

/// "none", then the names of all_indirect_methods().
const std::vector<std::string>& indirect_names();
/// The same of the indirect layer; nothing for "none", which has no parameters.
std::optional<IndirectMethod> parse_indirect(const std::string& name, const JsonNode& params);

/// `--param k=v` as a JSON object for parse_method; a value is JSON, or else a string. Throws
/// InputError naming the option for an assignment without '=' or a key given twice.
JsonNode parameters_node(const std::vector<std::string>& assignments,
                         const std::string& option = "--param");

/// Every parameter with the value in force, defaults included: parse_method reads it back to the
/// same method.
nlohmann::json describe(const Method& method);
nlohmann::json describe(const IndirectMethod& method);

/// The files that the methods' parameters read, by parameter (those of the indirect layer with "indirect_"
/// before), as hashes of their contents. Throws InputError for a file that is not what the parameter asks for.
std::map<std::string, std::string> files_read(const Method& method,
                                              const std::optional<IndirectMethod>& indirect);

/// What distinguishes two runs: describe() with the hashes of files in place of their names.
nlohmann::json identity(const Method& method);
nlohmann::json identity(const IndirectMethod& method);

/// How often the method goes through its precompute pass (`passes`); 1 for most.
int pass_count(const Method& method);

/// Runs the method's precompute pass, for a method of several passes the one of that number.
std::unique_ptr<const CausticEstimator> build(const Scene& scene, const Method& method,
                                              const RunOptions& options, int pass = 0);

/// What the least work tells of how a method does in a scene.
struct Serving {
    std::optional<std::string> why_not;  ///< it cannot serve the scene
    BuildReport report = {};             ///< else
};
template <class Estimator>
Serving try_serving(const Scene& scene, const MethodOf<Estimator>& method) {
    try {
        return {
            {},
            method.configured->with_least_work()->build(scene, RunOptions{}, 0)->build_report()};
    } catch (const UnsupportedScene& unsupported) {
        return {unsupported.what()};
    }
}

/// Why the method cannot serve the scene; empty when it can.
template <class Estimator>
std::optional<std::string> why_unsupported(const Scene& scene, const MethodOf<Estimator>& method) {
    return try_serving(scene, method).why_not;
}

}  // namespace caustics::experiments
