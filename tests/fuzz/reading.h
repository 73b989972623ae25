#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace caustics::fuzz {

/// The folder of this process that inputs are written to; removed at the end.
const std::filesystem::path& scratch();

/// The name of a file in the scratch folder, whether it is there or not.
std::filesystem::path named(const std::filesystem::path& name);
/// Writes that file; folders on the way are made.
std::filesystem::path put(const std::filesystem::path& name, std::string_view bytes);
inline std::string_view view(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// What a program's kind of file knows; defined by targets whose inputs are changed by words (json_hooks.h, word_hooks.h).
const std::vector<std::string>& words();

/// Whether an input is one of so many, by its hash: of these alone, what costs much is asked as well.
bool one_in(unsigned share, std::string_view bytes);

/// Ends the process with the reason: what the fuzzer keeps as a crash.
[[noreturn]] void fail(const std::string& reason);
inline void require(bool holds, const char* reason) {
    if (!holds) fail(reason);
}

/// Whether the input is taken. One that is not must be refused by InputError or UnsupportedScene,
/// in one line, which names a file of the scratch folder where `naming` says so.
enum class Naming { file, nothing };
bool taken(Naming naming, const std::function<void()>& read);

}  // namespace caustics::fuzz
