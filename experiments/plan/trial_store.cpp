#include "experiments/plan/trial_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "core/base/disk.h"
#include "core/base/error.h"
#include "experiments/base/bounded_json.h"
#include "experiments/base/file_io.h"
#include "experiments/plan/record.h"

namespace caustics::experiments {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view new_prefix = ".tmp-";
constexpr std::string_view old_prefix = ".old-";

[[noreturn]] void cannot_be_written(const fs::path& place, const std::error_code& error) {
    throw InputError(fmt::format("{}: cannot be written ({})", place.string(), error.message()));
}

}  // namespace

void TrialStore::prepare() const {
    try {
        make_folders(trials_);
        for (const fs::directory_entry& entry : fs::directory_iterator(trials_)) {
            const std::string name = entry.path().filename().string();
            const fs::path replaced =
                trials_ / name.substr(std::min(name.size(), old_prefix.size()));
            if (name.starts_with(old_prefix) && !fs::exists(replaced))
                fs::rename(entry.path(), replaced);
            else if (name.starts_with(old_prefix) || name.starts_with(new_prefix))
                fs::remove_all(entry.path());
        }
    } catch (const fs::filesystem_error& error) {
        cannot_be_written(trials_, error.code());
    }
}

std::optional<nlohmann::json> TrialStore::record(const std::string& id) const {
    const fs::path file = record_of(id);
    const auto require = [&](bool whole, const std::string& flaw) {
        if (!whole)
            throw BrokenRecord(fmt::format("{}: broken record ({}); a sweep runs the trial again",
                                           file.string(), flaw));
    };
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (status.type() == fs::file_type::not_found) return {};
    require(error != std::errc::too_many_symbolic_link_levels, error.message());
    // It may be whole: a disk that fails for a moment must not cost a trial.
    if (error)
        throw InputError(fmt::format("{}: cannot be read ({})", file.string(), error.message()));
    require(fs::is_regular_file(status), "not a file");
    nlohmann::json record = parse_bounded_or_discard(read_whole_file(file));
    require(!record.is_discarded(), "not JSON, or nested too deep");
    const std::string flaw = flaw_of(record);
    require(flaw.empty(), flaw);
    require(record.contains("trial") && record.at("trial") == nlohmann::json(id),
            "/trial: names another trial");
    return record;
}

fs::path TrialStore::temporary_of(const std::string& id) const {
    return trials_ / fmt::format("{}{}", new_prefix, id);
}

fs::path TrialStore::begin(const std::string& id) const {
    fs::path folder = temporary_of(id);
    std::error_code error;
    fs::remove_all(folder, error);
    if (!error) fs::create_directory(folder, error);
    if (error) cannot_be_written(folder, error);
    return folder;
}

void TrialStore::commit(const std::string& id, const nlohmann::json& record) const {
    const fs::path folder = temporary_of(id);
    const fs::path old = trials_ / fmt::format("{}{}", old_prefix, id);
    const fs::path place = folder_of(id);
    write_atomic_file(folder / "record.json",
                      record.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    try {
        // A rename may get to the disk before what it names.
        for (const fs::directory_entry& file : fs::directory_iterator(folder))
            bring_to_disk(file.path());
        bring_to_disk(folder);
        if (fs::exists(place)) fs::rename(place, old);
        fs::rename(folder, place);
        bring_to_disk(trials_);  // before anything of the earlier one goes
        fs::remove_all(old);
    } catch (const fs::filesystem_error& error) {
        cannot_be_written(place, error.code());
    }
}

std::vector<std::string> TrialStore::trials() const {
    std::vector<std::string> ids;
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(trials_, none)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(old_prefix) && !name.starts_with(new_prefix) &&
            entry.is_directory(none))
            ids.push_back(name);
    }
    return ids;
}

void TrialStore::drop(const std::string& id) const noexcept {
    try {
        fs::remove_all(temporary_of(id));
    } catch (const std::exception&) {}
}

void TrialStore::remove(const std::string& id) const {
    std::error_code error;
    fs::remove_all(folder_of(id), error);
    if (error) cannot_be_written(folder_of(id), error);
}

}  // namespace caustics::experiments
