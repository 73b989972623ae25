#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "experiments/base/csv.h"
#include "experiments/base/number_option.h"
#include "experiments/cli/verbs.h"

namespace caustics::experiments {

namespace {

namespace fs = std::filesystem;

constexpr const char* python = "/usr/bin/python3";  // Debian's, which sees Debian's NumPy and SciPy

struct ReportOptions {
    std::vector<std::string> folders;
    std::string output;               ///< empty: in the folder
    std::vector<std::string> values;  ///< "--option=value", ...
    std::optional<double> megabytes;
};

/// The tool beside the program: in a folder above a build, or where it was installed.
fs::path report_tool() {
    std::error_code unknown;
    const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
    for (fs::path place = program.parent_path(); place.has_relative_path();
         place = place.parent_path())
        for (const char* below : {"tools", "share/causticbench/tools"}) {
            const fs::path tool = place / below / "make_report.py";
            if (fs::is_regular_file(tool, unknown)) return tool;
        }
    throw InputError(
        fmt::format("report: tools/make_report.py is in no folder above {} (run it "
                    "from its source instead)",
                    program.string()));
}

/// The page: as it is named, in a folder that is named, or in the only folder of results. A report takes the place of an earlier
/// one alone.
std::string page_of(const ReportOptions& options) {
    fs::path page = options.output;
    if (options.output.empty()) {
        if (options.folders.size() != 1)
            throw InputError("-o: name the page to write for several folders: -o report.html");
        page = options.folders[0];
    }
    std::error_code none;
    if (fs::is_directory(page, none)) page /= "report.html";
    if (page.extension() != ".html")
        throw InputError(fmt::format("-o {}: pages are written as .html", page.string()));
    require_writable_place(page);
    return page.string();
}

/// Becomes the tool; returns only by throwing.
int run_tool(const ReportOptions& options) {
    std::vector<std::string> words = {python, report_tool().string(),
                                      "--output=" + page_of(options)};
    words.insert(words.end(), options.values.begin(), options.values.end());
    if (options.megabytes) {
        words.push_back("--megabytes=" + shortest(*options.megabytes));
    }
    words.emplace_back("--");
    words.insert(words.end(), options.folders.begin(), options.folders.end());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(python, arguments.data());
    throw InputError(
        fmt::format("{}: {} (report needs Debian's python3, python3-numpy and "
                    "python3-scipy)",
                    python, std::generic_category().message(errno)));
}

}  // namespace

Verb add_report(CLI::App& app) {
    auto options = std::make_shared<ReportOptions>();
    CLI::App* const verb =
        app.add_subcommand("report", "Make one HTML file of the records and pictures of sweeps");
    verb->add_option("DIR", options->folders, "Folders of results")->required();
    const auto handed_on = [&](const char* flags, const char* type, const char* what) {
        const std::string flag = std::string(flags).substr(std::string(flags).rfind("--"));
        return verb
            ->add_option_function<std::string>(
                flags,
                [options, flag](const std::string& value) {
                    options->values.push_back(flag + "=" + value);
                },
                what)
            ->type_name(type);
    };
    verb->add_option("-o,--output", options->output,
                     "The page to write, .html, or a folder for it (default: DIR/report.html)")
        ->type_name("FILE");
    handed_on("--tables", "FOLDER", "Writes every table there, as CSV and LaTeX (booktabs)");
    handed_on("--columns", "NAMES", "Columns of the LaTeX tables (default: rmse,work_s)");
    handed_on("--references", "FOLDER", "Where references are kept as well");
    add_number(*verb, "--megabytes", options->megabytes, 0.001, 10'000.0,
               "Most that the pictures may take (default 30); the rest are left out by name");
    verb->footer(
        "The page opens without a network and holds all it shows. It is made by "
        "tools/make_report.py "
        "with Debian's Python.\nExample:\n  causticbench report results/quickstart -o report.html");
    return {verb, [options] { return run_tool(*options); }};
}

}  // namespace caustics::experiments
