#include "tests/fuzz/word_mutator.h"

#include <algorithm>
#include <array>
#include <random>
#include <string_view>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace caustics::fuzz {
namespace {

constexpr std::array numbers = {"0",
                                "1",
                                "2",
                                "3",
                                "4",
                                "5",
                                "255",
                                "256",
                                "65536",
                                "0.5",
                                "-1",
                                "-2",
                                "-0",
                                "1e-3",
                                "+1",
                                ".5",
                                "5.",
                                "01",
                                "1e19",
                                "1e30",
                                "-1e30",
                                "1e39",
                                "1e999",
                                "nan",
                                "inf",
                                "-inf",
                                "1e-320",
                                "0x10",
                                "1e-45",
                                "1e8",
                                "4294967296",
                                "1,5",
                                "1e-8",
                                "1e",
                                "-",
                                "16777217",
                                "1000000",
                                "2147483647",
                                "2147483648",
                                "-2147483649",
                                "18446744073709551616",
                                ""};

/// Part of a text.
struct Range {
    std::size_t begin;
    std::size_t end;
};

class TextMutation {
public:
    TextMutation(std::string& text, unsigned seed, const std::vector<std::string>& known)
        : text_(text), random_(seed), known_(known) {}

    void apply() {
        switch (below(8)) {
            case 0: insert(word().end, separator() + anything()); break;
            case 1: erase(word()); break;
            case 2: insert(line().begin, copy_of(line())); break;
            case 3: erase(line()); break;
            case 4: insert(word().begin, copy_of(word()) + separator()); break;
            default: replace(word()); break;
        }
    }

private:
    std::size_t below(std::size_t count) { return random_() % count; }

    std::string anything() {
        return known_.empty() || below(2) == 0 ? numbers[below(numbers.size())]
                                               : known_[below(known_.size())];
    }
    std::string separator() { return std::string(1, " \n,=/"[below(5)]); }

    /// The word at some place.
    Range word() {
        constexpr std::string_view between = " \n\r\t,=/";
        const std::size_t at = below(text_.size() + 1);
        const std::size_t before =
            at == 0 ? std::string::npos : text_.find_last_of(between, at - 1);
        return {before == std::string::npos ? 0 : before + 1,
                std::min(text_.find_first_of(between, at), text_.size())};
    }
    /// The line at some place, with its end.
    Range line() {
        const std::size_t at = below(text_.size() + 1);
        const std::size_t before = at == 0 ? std::string::npos : text_.rfind('\n', at - 1);
        const std::size_t end = text_.find('\n', at);
        return {before == std::string::npos ? 0 : before + 1,
                end == std::string::npos ? text_.size() : end + 1};
    }

    std::string copy_of(const Range& range) const {
        return text_.substr(range.begin, range.end - range.begin);
    }
    void insert(std::size_t at, const std::string& what) { text_.insert(at, what); }
    void erase(const Range& range) { text_.erase(range.begin, range.end - range.begin); }
    void replace(const Range& range) {
        text_.replace(range.begin, range.end - range.begin, anything());
    }

    std::string& text_;
    std::minstd_rand random_;
    const std::vector<std::string>& known_;
};

}  // namespace

std::size_t mutate_words(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed,
                         const std::vector<std::string>& known) {
    if (seed % 4 == 0) return LLVMFuzzerMutate(data, size, most);
    std::string text(reinterpret_cast<const char*>(data), size);
    TextMutation mutation(text, seed, known);
    for (unsigned changes = 1 + seed % 3; changes > 0; --changes) mutation.apply();
    text.resize(std::min(text.size(), most));
    std::ranges::copy(text, data);
    return text.size();
}

}  // namespace caustics::fuzz
