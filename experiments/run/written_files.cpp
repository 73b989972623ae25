#include "experiments/run/written_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/error.h"

namespace caustics::experiments {

namespace {

namespace fs = std::filesystem;

/// One name of a file, whatever it is called and whether it is there or not.
fs::path real_place(const fs::path& file) {
    std::error_code unknown;
    const fs::path whole = fs::absolute(file, unknown);
    const fs::path place = fs::weakly_canonical(whole, unknown);
    return unknown ? whole.lexically_normal() : place;
}

/// Who reads and writes which file.
class Users {
public:
    void add_read(const fs::path& file) { read_.insert(real_place(file)); }

    void add_written(const std::string& file, const std::string& option) {
        const fs::path place = real_place(file);
        if (read_.contains(place))
            throw InputError(fmt::format(
                "{}: is read, and {} would take its place; name another file", file, option));
        const auto [found, is_new] = written_.emplace(place, option);
        if (!is_new)
            throw InputError(
                fmt::format("{}: named by {} and by {}, of which the one would take the other's "
                            "place; give each a file of its own",
                            file, found->second, option));
    }

    template <typename SomeMethod>
    void add_read(const SomeMethod& method) {
        const nlohmann::json values = describe(method);
        for (const auto& [key, checksum] : method.configured->files_read())
            add_read(fs::path(values.at(key).template get<std::string>()));
    }

    template <typename SomeMethod>
    void add_written(const SomeMethod& method, const std::string& option) {
        const nlohmann::json values = describe(method);
        for (const std::string& key : method.configured->files_written())
            add_written(values.at(key).template get<std::string>(), option + " " + key);
    }

private:
    std::set<fs::path> read_;
    std::map<fs::path, std::string> written_;
};

}  // namespace

void require_files_apart(const std::vector<std::string>& outputs, const RunRequest& request,
                         const std::vector<fs::path>& read) {
    Users users;
    for (const fs::path& file : read) users.add_read(file);
    if (request.method.configured) users.add_read(request.method);
    if (request.indirect) users.add_read(*request.indirect);
    for (const std::string& output : outputs) users.add_written(output, "-o");
    if (request.method.configured) users.add_written(request.method, "--param");
    if (request.indirect) users.add_written(*request.indirect, "--indirect-param");
}

}  // namespace caustics::experiments
