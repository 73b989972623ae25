#pragma once

#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/caustic_estimator.h"
#include "core/method/method_description.h"
#include "core/scene_file/json_reader.h"

namespace caustics::experiments {

/// A method with its parameters, as the harness passes it on; parse_method makes it.
struct Method {
    std::string name;
    const MethodDescription* description = nullptr;
    std::shared_ptr<const ConfiguredMethod> configured = {};

    const MethodFacts& facts() const { return description->facts(); }
};

/// The names of all_methods(), in its order.
const std::vector<std::string>& method_names();

/// Nothing where no method has that name.
const MethodDescription* find_method(const std::string& name);

/// The method of that name with its parameters read. Throws InputError listing the names, or from
/// the method's own table.
Method parse_method(const std::string& name, const JsonNode& params);

/// `--param k=v` as a JSON object for parse_method; a value is JSON, or else a string. Throws
/// InputError for an assignment without '=' or a key given twice.
JsonNode parameters_node(const std::vector<std::string>& assignments);

/// Every parameter with the value in force, defaults included: parse_method reads it back to the
/// same method.
nlohmann::json describe(const Method& method);

/// The files that the method's parameters read, by parameter, as hashes of their contents. Throws
/// InputError for a file that is not what the parameter asks for.
std::map<std::string, std::string> files_read(const Method& method);

/// What distinguishes two runs: describe() with the hashes of files in place of their names.
nlohmann::json identity(const Method& method);

/// How often the method goes through its precompute pass (`passes`); 1 for most.
int pass_count(const Method& method);

/// Runs the method's precompute pass, for a method of several passes the one of that number.
std::unique_ptr<const CausticEstimator> build(const Scene& scene, const Method& method,
                                              const RunOptions& options, int pass = 0);

/// Why the method cannot serve the scene; empty when it can.
std::optional<std::string> why_unsupported(const Scene& scene, const Method& method);

/// Whether the method answers a probe by gathering over a disc round each point, all points at
/// once on its own threads; such points need a radius.
bool gathers_over_discs(const Method& method);
/// The disc's radius [m] for points that have none of their own; 0 = none.
double disc_radius(const Method& method);

}  // namespace caustics::experiments
