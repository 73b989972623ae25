#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <clocale>
#include <csignal>
#include <filesystem>
#include <new>
#include <sstream>
#include <vector>

#include "core/base/error.h"
#include "experiments/base/environment.h"
#include "experiments/base/file_io.h"
#include "experiments/base/signals.h"
#include "experiments/cli/verbs.h"

namespace caustics::experiments {

namespace {

enum ExitCode { done = 0, failed = 1, bad_input = 2, unsupported = 3, interrupted = 130 };

int report(const std::string& message, ExitCode code) {
    write_stderr(fmt::format("causticbench: error: {}\n", one_line(message)));
    return code;
}

std::string verb_names(const std::vector<Verb>& verbs) {
    std::string names;
    for (const Verb& verb : verbs) names += (names.empty() ? "" : ", ") + verb.app->get_name();
    return names;
}

std::string option_names(const CLI::App& app) {
    std::string names;
    for (const CLI::Option* option : app.get_options())
        if (!option->get_positional())
            names += (names.empty() ? "" : ", ") + option->get_name(false, true);
    return names;
}

/// The parser's own messages name no alternatives, and it complains of what is missing before what
/// is misspelt; so unknown words are looked for first.
void require_known_words(const CLI::App& app, const std::vector<Verb>& verbs,
                         const std::vector<std::string>& words) {
    if (words.empty()) throw InputError("no verb given (known: " + verb_names(verbs) + ")");
    const CLI::App* scope = &app;
    if (words[0][0] != '-') {
        const auto verb = std::ranges::find_if(
            verbs, [&](const Verb& each) { return each.app->get_name() == words[0]; });
        if (verb == verbs.end())
            throw InputError(
                fmt::format("unknown verb \"{}\" (known: {})", words[0], verb_names(verbs)));
        scope = verb->app;
    }
    for (const std::string& word : words) {
        if (word.size() < 3 || word.compare(0, 2, "--") != 0) continue;
        const std::string name = word.substr(0, word.find('='));
        if (scope->get_option_no_throw(name) == nullptr)
            throw InputError(
                fmt::format("unknown option {} (known: {})", name, option_names(*scope)));
    }
}

int run_verb(const std::vector<Verb>& verbs) {
    for (const Verb& verb : verbs)
        if (verb.app->parsed()) return verb.run();
    throw InputError("no verb given (known: " + verb_names(verbs) + ")");
}

int parse_and_run(int argc, char** argv) {
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
            write_stdout(text.str());
            return done;
        }
        throw InputError(one_line(error.what()) + " (see --help)");
    }
    return run_verb(verbs);
}

int run_and_report(int argc, char** argv) {
    try {
        return parse_and_run(argc, argv);
    } catch (const InputError& error) {
        return report(error.what(), bad_input);
    } catch (const UnsupportedScene& error) {
        return report(error.what(), unsupported);
    } catch (const Interrupted& error) {
        return report(error.what(), interrupted);
    } catch (const std::filesystem::filesystem_error& error) {
        return report(reason_of(error), bad_input);
    } catch (const std::bad_alloc&) {
        return report(fmt::format("out of memory: {}", fmt::join(argv + 1, argv + argc, " ")),
                      failed);
    } catch (const std::exception& error) {
        return report(error.what(), failed);
    }
}

}  // namespace

}  // namespace caustics::experiments

int main(int argc, char** argv) {
    using namespace caustics;
    using namespace caustics::experiments;
    std::setlocale(LC_ALL, "C");
    hold_standard_streams();
    catch_interrupts();
    std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is a failed write like others
    try {
        return run_and_report(argc, argv);
    } catch (const std::bad_alloc&) {  // not even for the message
        write_stderr("causticbench: error: out of memory\n");
        return failed;
    }
}
