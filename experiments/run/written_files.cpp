#include "experiments/run/written_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace caustics::experiments {

namespace {

namespace fs = std::filesystem;

/// Who writes which file, by its place.
class Writers {
public:
    void add(const std::string& file, const std::string& option) {
        std::error_code unknown;
        const fs::path whole = fs::absolute(file, unknown);
        const fs::path place = fs::weakly_canonical(whole, unknown);
        const auto [found, is_new] =
            options_.emplace(unknown ? whole.lexically_normal() : place, option);
        if (!is_new)
            throw InputError(
                fmt::format("{}: named by {} and by {}, of which the one would take the other's "
                            "place; give each a file of its own",
                            file, found->second, option));
    }

    template <typename SomeMethod>
    void add(const SomeMethod& method, const std::string& option) {
        const nlohmann::json values = describe(method);
        for (const std::string& key : method.configured->files_written())
            add(values.at(key).template get<std::string>(), option + " " + key);
    }

private:
    std::map<fs::path, std::string> options_;
};

}  // namespace

void require_files_apart(const std::vector<std::string>& outputs, const RunRequest& request) {
    Writers writers;
    for (const std::string& output : outputs) writers.add(output, "-o");
    if (request.method.configured) writers.add(request.method, "--param");
    if (request.indirect) writers.add(*request.indirect, "--indirect-param");
}

}  // namespace caustics::experiments
