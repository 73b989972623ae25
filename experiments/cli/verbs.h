#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace caustics::experiments {

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
Verb add_report(CLI::App& app);
Verb add_verify(CLI::App& app);
Verb add_export(CLI::App& app);
Verb add_help(CLI::App& app);

inline std::vector<Verb> add_verbs(CLI::App& app) {
    return {add_render(app), add_probe(app),  add_sweep(app),   add_compare(app),
            add_info(app),   add_merge(app),  add_explain(app), add_report(app),
            add_verify(app), add_export(app), add_help(app)};
}

inline std::vector<std::string> names_of(const std::vector<Verb>& verbs) {
    std::vector<std::string> names;
    for (const Verb& verb : verbs) names.push_back(verb.app->get_name());
    return names;
}

}  // namespace caustics::experiments
