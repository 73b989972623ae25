#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run/method.h"

namespace caustics::experiments {

/// A sweep file as it is written (contract: sweeps), with its products not yet formed.
struct SweepFile {
    /// A value of every scene, and the column it becomes.
    struct Axis {
        std::string name;
        std::string pointer;
        std::vector<std::string> values;  ///< JSON texts
    };
    /// One combination of a method's parameters, as the file names them.
    struct MethodCase {
        Method method;
        std::vector<std::pair<std::string, std::string>> params;  ///< key, JSON text
    };
    /// The same of a method of the indirect layer.
    struct IndirectCase {
        std::optional<IndirectMethod> method = {};  ///< none: without that layer
        std::vector<std::pair<std::string, std::string>> params = {};
    };
    struct Reference {
        Method method;
        std::optional<IndirectMethod> indirect = {};
        int spp = 0;
        std::uint64_t seed = 1;
    };

    std::filesystem::path file;
    std::vector<std::filesystem::path> scenes;
    std::vector<Axis> axes;  ///< no two with the same pointer
    std::vector<MethodCase> methods;
    std::vector<IndirectCase> indirect = {{}};
    std::vector<std::uint64_t> seeds;
    int repeats = 1;
    int spp = 16;
    int threads = 1;
    std::optional<Reference> reference;
};

/// Throws InputError naming file and JSON pointer for unknown keys, empty lists and bad values.
SweepFile read_sweep_file(const std::filesystem::path& file);

}  // namespace caustics::experiments
