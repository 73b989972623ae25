#include <memory>

#include "experiments/base/file_io.h"
#include "experiments/cli/help_text.h"
#include "experiments/cli/verbs.h"

namespace caustics::experiments {

Verb add_help(CLI::App& app) {
    auto topic = std::make_shared<std::string>();
    CLI::App* const verb =
        app.add_subcommand("help", "Every key of a method or a kind of file, with its meaning");
    verb->add_option("TOPIC", *topic, "What to tell about (default: the topics)");
    verb->footer("Example:\n  causticbench help photonmap");
    return {verb, [topic] {
                write_stdout(help_text(*topic));
                return 0;
            }};
}

}  // namespace caustics::experiments
