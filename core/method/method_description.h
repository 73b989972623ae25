#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/caustic_estimator.h"
#include "core/indirect_estimator.h"
#include "core/method/parameter.h"

namespace caustics {

/// How a method's picture is made of samples, so that one can go on where a smaller one ended.
struct SampleCount {
    std::string parameter = {};  ///< that says how many; empty: the method has no such number
    /// Whether they count for each pixel, shared by the eye pass's samples, at least one each.
    bool of_a_pixel = false;

    /// Answers whether light paths connect to the camera by themselves, however many pixels are asked for.
    bool is_of_picture() const { return !parameter.empty() && !of_a_pixel; }
};

/// The whole number that a method's time grows with.
struct WorkParameter {
    std::string parameter = {};  ///< empty: the method has no such number
    std::string instead = {};    ///< another parameter, which a user may give in its place
    int power = 1;               ///< of it, in which time grows, but for a constant
    std::int64_t first = 1;      ///< that costs next to nothing
    std::int64_t most = 1;
};

/// What is known of a method whatever its parameters.
struct MethodFacts {
    std::string name;
    std::string summary;  ///< what it is, in one line
    std::string serves;   ///< which scenes, lights and pixels
    bool has_caustic = true;
    bool is_unbiased = false;  ///< so that it may serve as a reference
    SampleCount samples = {};
    WorkParameter work = {};  ///< unless its parameters choose another (ConfiguredParameters::work)
    bool gathers_over_discs = false;  ///< answers a probe over a disc round each point, all at once
    /// Further numbers that must grow with the work for the method to converge.
    std::vector<WorkParameter> refined_with = {};
};

/// A method with its parameters in place, whatever it estimates. Immutable.
class ConfiguredParameters {
public:
    virtual ~ConfiguredParameters() = default;

    /// Every parameter with the value in force, defaults included.
    virtual std::vector<std::pair<std::string, ParameterValue>> values() const = 0;
    /// What stands for the contents of the files that are read, by parameter. Throws InputError for a
    /// file that is not what the parameter asks for.
    virtual std::map<std::string, std::uint64_t> files_read() const = 0;
    /// The parameters that name files to be written.
    virtual std::vector<std::string> files_written() const = 0;
    /// How often the method goes through its precompute pass; 1 for most.
    virtual int pass_count() const = 0;
    /// The whole number that its time grows with, as its other parameters are.
    virtual WorkParameter work() const = 0;
    /// Of points in `probe` that have none of their own [m]; 0 = none.
    virtual double disc_radius() const = 0;
};

/// The same, ready to be built.
template <class Estimator>
class ConfiguredMethodOf : public ConfiguredParameters {
public:
    /// The same where building costs next to nothing: what a method can serve does not depend on how
    /// much work it is given.
    virtual std::shared_ptr<const ConfiguredMethodOf> with_least_work() const = 0;
    /// The same with about that share of its work, and the share that it then has: a trial that costs little and tells what
    /// all of it costs. The share is 1 where the method has no number to make smaller.
    virtual std::pair<std::shared_ptr<const ConfiguredMethodOf>, double> with_share_of_work(
        double share) const = 0;
    /// Runs the precompute pass of that number.
    virtual std::unique_ptr<const Estimator> build(const Scene& scene, const RunOptions& options,
                                                   int pass) const = 0;
};

/// A method as its own folder describes it: all that a program asks of methods it knows only by name.
template <class Estimator>
class MethodDescriptionOf {
public:
    virtual ~MethodDescriptionOf() = default;

    virtual const MethodFacts& facts() const = 0;
    virtual std::vector<KeyText> parameters() const = 0;
    /// Reads parameters strictly. Throws InputError naming the key and what is known.
    virtual std::shared_ptr<const ConfiguredMethodOf<Estimator>> configure(
        const JsonNode& node) const = 0;
};

using ConfiguredMethod = ConfiguredMethodOf<CausticEstimator>;
using MethodDescription = MethodDescriptionOf<CausticEstimator>;
using ConfiguredIndirect = ConfiguredMethodOf<IndirectEstimator>;
using IndirectDescription = MethodDescriptionOf<IndirectEstimator>;

}  // namespace caustics
