#include "core/base/near_words.h"

#include <algorithm>
#include <cstddef>

#include "core/base/lower_case.h"

namespace caustics {

namespace {

constexpr std::size_t most_edits = 2;

/// Edit distance with swaps of neighbours (optimal string alignment), row by row.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> before_last, last, row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before_last = std::move(last);
        last = row;
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before_last[j - 2] + 1);
        }
    }
    return row[b.size()];
}

/// Beyond `most_edits` where the lengths say so: a long name of a file costs nothing. At least one letter of the
/// longer word stays.
std::size_t bounded_distance(const std::string& a, const std::string& b) {
    const std::size_t longer = std::max(a.size(), b.size());
    if (longer - std::min(a.size(), b.size()) > most_edits) return most_edits + 1;
    const std::size_t distance = edit_distance(a, b);
    return distance < longer ? distance : most_edits + 1;
}

}  // namespace

std::vector<std::string> near_words(const std::string& word,
                                    const std::vector<std::string>& known) {
    std::size_t nearest = most_edits;
    std::vector<std::string> words;
    for (const std::string& candidate : known) {
        const std::size_t distance = bounded_distance(lower_case(word), lower_case(candidate));
        if (distance > nearest) continue;
        if (distance < nearest) words.clear();
        nearest = distance;
        if (std::ranges::find(words, candidate) == words.end()) words.push_back(candidate);
    }
    return words;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
    std::string text;
    for (const std::string& candidate : near_words(word, known))
        text += (text.empty() ? ": did you mean " : " or ") + candidate;
    return text.empty() ? "" : text + "?";
}

}  // namespace caustics
