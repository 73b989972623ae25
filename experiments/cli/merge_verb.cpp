#include <fmt/format.h>

#include <memory>

#include "experiments/base/file_io.h"
#include "experiments/cli/verbs.h"
#include "experiments/sweep/merge.h"

namespace caustics::experiments {

Verb add_merge(CLI::App& app) {
    struct Flags {
        std::vector<std::string> folders;
        std::string target;
    };
    auto flags = std::make_shared<Flags>();
    CLI::App* const verb =
        app.add_subcommand("merge", "Put the results of a sweep's shards together");
    verb->add_option("DIR", flags->folders, "Folders of the shards")->required();
    verb->add_option("-o,--output", flags->target, "Folder of the whole, not there yet")
        ->required()
        ->type_name("DIR");
    verb->footer(
        "Every trial of the plan must be in one of the folders, and in one only; code and "
        "instruction set must be the same.\nMixed processors are warned of: their times do not "
        "compare.\nExample:\n  causticbench merge out/1 out/2 out/3 -o out/all");
    return {verb, [flags] {
                const auto warnings =
                    merge_results({flags->folders.begin(), flags->folders.end()}, flags->target);
                for (const std::string& warning : warnings)
                    write_stderr(fmt::format("warning: {}\n", warning));
                return 0;
            }};
}

}  // namespace caustics::experiments
