#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "core/base/error.h"
#include "experiments/base/file_io.h"
#include "experiments/cli/help_text.h"
#include "experiments/cli/verbs.h"

namespace caustics::experiments {

namespace {

/// Verbs have words of their own to say.
void require_no_verb(const std::string& topic) {
    const std::vector<std::string> topics = help_topics();
    if (std::ranges::find(topics, topic) != topics.end()) return;
    CLI::App app;
    for (const Verb& verb : add_verbs(app))
        if (verb.app->get_name() == topic)
            throw InputError(
                fmt::format("\"{}\" is a verb, of which causticbench {} --help tells (topics: {})",
                            topic, topic, fmt::join(topics, ", ")));
}

}  // namespace

Verb add_help(CLI::App& app) {
    auto topic = std::make_shared<std::string>();
    CLI::App* const verb =
        app.add_subcommand("help", "Every key of a method or a kind of file, with its meaning");
    verb->add_option("TOPIC", *topic, "What to tell about (default: the topics)");
    verb->footer("Example:\n  causticbench help photonmap");
    return {verb, [topic] {
                require_no_verb(*topic);
                write_stdout(help_text(*topic));
                return 0;
            }};
}

}  // namespace caustics::experiments
