#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/atomic_file.h"
#include "core/scene/scene_reader.h"
#include "experiments/run/method.h"

namespace caustics::experiments {

/// Options that verbs share. Each adds itself to a verb and says what was given.
struct SceneOptions {
    std::string file;
    std::vector<std::string> sets;

    void add_to(CLI::App& verb);
    /// `--set` as pairs; throws InputError without '='.
    Overrides overrides() const;
    SceneFile load(PictureDepth textures = PictureDepth::whole) const;
};

struct MethodOptions {
    std::string name;
    std::vector<std::string> params;

    void add_to(CLI::App& verb, bool required = true);
    Method parse() const;
};

/// The method of the indirect layer, `none` where it is not named.
struct IndirectOptions {
    std::string name = "none";
    std::vector<std::string> params;

    void add_to(CLI::App& verb);
    std::optional<IndirectMethod> parse() const;
};

/// What of the machine a run may use.
struct MachineFlags {
    int threads = 0;         ///< 0: not given
    Isa isa = widest_isa();  ///< of the methods' hot loops

    void add_to(CLI::App& verb, const std::string& default_threads);
};

struct RunFlags {
    std::uint64_t seed = 1;
    MachineFlags machine;

    void add_to(CLI::App& verb);
    RunOptions options(int samples_per_pixel) const;
};

/// Samples a pixel as asked for, or the scene's when `asked` is 0. Throws InputError when they do
/// not fit the scene's sampler.
int samples_per_pixel(const PixelSampling& sampling, int asked, const std::string& place = "--spp");

/// What a user should know beside the answer: a line each on stderr.
void print_notes(const std::vector<std::string>& notes);

/// An option that may be given many times, each time with one value.
CLI::Option* add_repeatable(CLI::App& verb, const std::string& name,
                            std::vector<std::string>& values, const std::string& help);

}  // namespace caustics::experiments
