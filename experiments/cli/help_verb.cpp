#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/near_words.h"
#include "experiments/base/file_io.h"
#include "experiments/cli/help_text.h"
#include "experiments/cli/verbs.h"

namespace caustics::experiments {

namespace {

/// The text that `causticbench VERB --help` prints. It is empty where no verb has that name.
std::string verb_help(const std::vector<Verb>& verbs, const std::string& name) {
    for (const Verb& verb : verbs)
        if (verb.app->get_name() == name) return verb.app->help("causticbench");
    return {};
}

/// Topics and verbs; a name of both is listed once.
std::vector<std::string> known_topics(const std::vector<Verb>& verbs) {
    std::vector<std::string> known = help_topics();
    for (const std::string& name : names_of(verbs))
        if (std::ranges::find(known, name) == known.end()) known.push_back(name);
    return known;
}

void print_help(const std::string& topic) {
    CLI::App app;
    const std::vector<Verb> verbs = add_verbs(app);
    const std::string text = verb_help(verbs, topic) + help_text(topic);
    if (text.empty()) {
        const std::vector<std::string> known = known_topics(verbs);
        throw InputError(fmt::format("unknown topic \"{}\"{} (known: {})", topic,
                                     did_you_mean(topic, known), fmt::join(known, ", ")));
    }
    write_stdout(text);
    if (topic.empty())
        write_stdout(fmt::format("help VERB prints what VERB --help does: {}.\n",
                                 fmt::join(names_of(verbs), ", ")));
}

}  // namespace

Verb add_help(CLI::App& app) {
    auto topic = std::make_shared<std::string>();
    CLI::App* const verb = app.add_subcommand(
        "help", "The options of a verb, or every key of a method or a kind of file");
    verb->add_option("TOPIC", *topic, "Verb, method or kind of file (default: a list of them)");
    verb->footer("Example:\n  causticbench help photonmap\n  causticbench help render");
    return {verb, [topic] {
                print_help(*topic);
                return 0;
            }};
}

}  // namespace caustics::experiments
