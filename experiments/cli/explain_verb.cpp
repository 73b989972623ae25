#include <memory>

#include "experiments/base/file_io.h"
#include "experiments/cli/explain.h"
#include "experiments/cli/verbs.h"

namespace caustics::experiments {

Verb add_explain(CLI::App& app) {
    struct Flags {
        std::string folder;
        std::string trial;
    };
    auto flags = std::make_shared<Flags>();
    CLI::App* const verb =
        app.add_subcommand("explain", "Print the command that makes a trial's picture again");
    verb->add_option("DIR", flags->folder, "Folder of the results")->required();
    verb->add_option("TRIAL", flags->trial, "Its name, the beginning of it, or its config_hash")
        ->required();
    verb->footer(
        "Prints lines for a shell: remarks begin with #.\nExample:\n  causticbench explain out "
        "ring-photonmap-s1-0123456789abcdef");
    return {verb, [flags] {
                write_stdout(explain(flags->folder, flags->trial));
                return 0;
            }};
}

}  // namespace caustics::experiments
