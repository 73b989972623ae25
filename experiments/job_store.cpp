#include "experiments/job_store.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <charconv>

#include "core/error.h"
#include "experiments/files.h"

namespace caustics {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view temporary_prefix = ".tmp-";

fs::path temporary_name(const fs::path& folder, const std::string& id, const char* what) {
    return folder / fmt::format("{}{}{}-{}", temporary_prefix, what, id, getpid());
}

/// Whether the process that a temporary name ends with still runs and is not this one.
bool belongs_to_other_process(const std::string& name) {
    const std::string digits = name.substr(name.rfind('-') + 1);
    pid_t process = 0;
    const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), process);
    if (result.ec != std::errc() || process <= 0 || process == getpid()) return false;
    return kill(process, 0) == 0 || errno == EPERM;
}

}  // namespace

JobStore::JobStore(const fs::path& folder) : trials_(folder / "trials") {
    std::error_code error;
    fs::create_directories(trials_, error);
    if (error)
        throw InputError(fmt::format("{}: cannot be made ({})", trials_.string(), error.message()));
    remove_leftovers();
}

void JobStore::remove_leftovers() const {
    for (const fs::directory_entry& entry : fs::directory_iterator(trials_)) {
        const std::string name = entry.path().filename().string();
        const bool temporary = name.compare(0, temporary_prefix.size(), temporary_prefix) == 0;
        if (temporary && !belongs_to_other_process(name)) fs::remove_all(entry.path());
    }
}

std::optional<nlohmann::json> JobStore::record(const std::string& id) const {
    const fs::path file = trials_ / id / "record.json";
    if (!fs::exists(file)) return {};
    nlohmann::json record = nlohmann::json::parse(read_whole_file(file), nullptr, false);
    if (!record.is_object() || record.value("trial", "") != id || !record.contains("status"))
        throw InputError(fmt::format(
            "{}: broken record (remove the trial's folder to run it again)", file.string()));
    return record;
}

fs::path JobStore::image_of(const std::string& id) const { return trials_ / id / "image.exr"; }

void JobStore::add(const std::string& id, const TrialOutcome& outcome) const {
    const fs::path temporary = temporary_name(trials_, id, "");
    const fs::path old = temporary_name(trials_, id, "old-");
    const fs::path final_place = trials_ / id;
    try {
        fs::remove_all(temporary);
        fs::create_directory(temporary);
        if (outcome.film) write_exr(*outcome.film, temporary / "image.exr");
        write_whole_file(temporary / "log.txt", outcome.log);
        write_whole_file(temporary / "record.json", outcome.record.dump(2) + "\n");
        if (fs::exists(final_place)) fs::rename(final_place, old);
        fs::rename(temporary, final_place);
        fs::remove_all(old);
    } catch (const fs::filesystem_error& error) {
        throw InputError(fmt::format("{}: cannot be written ({})", final_place.string(),
                                     error.code().message()));
    }
}

}  // namespace caustics
