#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "experiments/base/file_io.h"
#include "experiments/cli/verbs.h"
#include "experiments/sweep/merge.h"

namespace caustics::experiments {

namespace {

/// Says what was put together: records, the folders they came from, references, the table.
std::string merged_text(const Merged& merged, const std::filesystem::path& target) {
    std::size_t records = 0;
    std::vector<std::string> from, statuses;
    for (const auto& [folder, count] : merged.trials) {
        records += count;
        from.push_back(fmt::format("{} of {}", count, folder.string()));
    }
    for (const auto& [status, count] : merged.statuses)
        statuses.push_back(fmt::format("{} {}", count, status));
    return fmt::format(
        "records    {} in {} ({}); none is in two folders\n"
        "from       {}\n"
        "references {} ({} duplicates left out)\n",
        records, (target / "records.csv").string(), fmt::join(statuses, ", "),
        fmt::join(from, ", "), merged.references, merged.repeated_references);
}

}  // namespace

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
                const Merged merged =
                    merge_results({flags->folders.begin(), flags->folders.end()}, flags->target);
                for (const std::string& warning : merged.warnings)
                    write_stderr(fmt::format("warning: {}\n", warning));
                write_stdout(merged_text(merged, flags->target));
                return 0;
            }};
}

}  // namespace caustics::experiments
