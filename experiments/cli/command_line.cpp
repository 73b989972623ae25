#include "experiments/cli/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/near_words.h"
#include "experiments/base/environment.h"
#include "experiments/base/file_io.h"
#include "experiments/cli/unknown_option.h"
#include "experiments/cli/verbs.h"

namespace caustics::experiments {

namespace {

[[noreturn]] void refuse_no_verb(const std::vector<Verb>& verbs) {
    throw InputError(fmt::format("no verb given (known: {})", fmt::join(names_of(verbs), ", ")));
}

/// The parser's own messages name no alternatives, and it complains of what is missing before what
/// is misspelt; so unknown words are looked for first.
void require_known_words(const CLI::App& app, const std::vector<Verb>& verbs,
                         const std::vector<std::string>& words) {
    if (words.empty()) refuse_no_verb(verbs);
    const CLI::App* scope = &app;
    if (words[0][0] != '-') {
        const auto verb = std::ranges::find_if(
            verbs, [&](const Verb& each) { return each.app->get_name() == words[0]; });
        if (verb == verbs.end())
            throw InputError(fmt::format("unknown verb \"{}\"{} (known: {})", words[0],
                                         did_you_mean(words[0], names_of(verbs)),
                                         fmt::join(names_of(verbs), ", ")));
        scope = verb->app;
    }
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i].size() < 3 || words[i].compare(0, 2, "--") != 0) continue;
        const std::string name = words[i].substr(0, words[i].find('='));
        if (scope->get_option_no_throw(name) == nullptr) refuse_option(*scope, words, i);
    }
}

/// An empty word is mostly a variable of the shell that holds nothing; it is no value of any option.
void require_no_empty_word(const std::vector<Verb>& verbs) {
    for (const Verb& verb : verbs)
        for (const CLI::Option* option : verb.app->get_options())
            if (std::ranges::find(option->results(), "") != option->results().end())
                throw InputError(fmt::format("{} \"\": an empty word (expected {}; see --help)",
                                             option->get_name(), option->get_type_name()));
}

std::function<int()> work_of(const std::vector<Verb>& verbs) {
    for (const Verb& verb : verbs)
        if (verb.app->parsed()) return verb.run;
    refuse_no_verb(verbs);
}

}  // namespace

std::function<int()> parse_command_line(int argc, const char* const* argv) {
    CLI::App app(
        "Caustic rendering methods compared: pictures, probes, sweeps with errors "
        "against references.",
        "causticbench");
    app.require_subcommand(0, 1);  // a topic, a file or a folder may be named like a verb
    app.set_version_flag("--version", "causticbench " + code_version());
    app.footer(
        "Exit codes: 0 done, 1 some trials failed, 2 bad input or usage, 3 the method cannot "
        "serve the scene, 130 interrupted.\nExample:\n  causticbench VERB --help");
    const std::vector<Verb> verbs = add_verbs(app);
    const std::vector<std::string> words(argv + 1, argv + argc);
    for (const std::string& word : words)
        if (!is_utf8(word))
            throw InputError(
                fmt::format("\"{}\" is not valid UTF-8, which records and pictures hold "
                            "(rename the file, or use a link)",
                            word));
    require_known_words(app, verbs, words);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {  // --help, --version
            std::ostringstream text;
            app.exit(error, text, text);
            return [answer = text.str()] {
                write_stdout(answer);
                return 0;
            };
        }
        throw InputError(one_line(error.what()) + " (see --help)");
    }
    require_no_empty_word(verbs);
    return work_of(verbs);
}

}  // namespace caustics::experiments
