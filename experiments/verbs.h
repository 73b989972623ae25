#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace caustics {

/// A verb of the command line: its options, and what it does once they are parsed. `run` returns
/// the exit code (0 done, 1 some trials failed) and throws InputError, UnsupportedScene or
/// Interrupted.
struct Verb {
    CLI::App* app = nullptr;
    std::function<int()> run;
};

Verb add_render(CLI::App& app);
Verb add_probe(CLI::App& app);
Verb add_sweep(CLI::App& app);
Verb add_compare(CLI::App& app);
Verb add_info(CLI::App& app);
Verb add_merge(CLI::App& app);
Verb add_explain(CLI::App& app);
Verb add_verify(CLI::App& app);
Verb add_export(CLI::App& app);

}  // namespace caustics
