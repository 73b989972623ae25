#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>

#include "core/mesh/obj_mesh.h"
#include "tests/fuzz/mesh_checks.h"
#include "tests/fuzz/word_hooks.h"

namespace {

using namespace caustics;

/// A word as a number; C's and Fortran's exponents and a plus sign count.
std::optional<double> number_of(std::string word) {
    if (word.size() > 1 && word[0] == '+') word.erase(0, 1);
    std::ranges::replace_if(word, [](char c) { return c == 'd' || c == 'D'; }, 'e');
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || !std::isfinite(value)) return {};
    return value;
}

/// The numbers among the words, sorted, and of each four after another word the first three over the fourth.
std::vector<float> numbers_of(const std::string& text) {
    std::vector<float> numbers;
    std::vector<double> of_vertex;
    std::istringstream in(text);
    for (std::string word; in >> word;) {
        const std::optional<double> value = number_of(word);
        if (!value) {
            of_vertex.clear();
            continue;
        }
        numbers.push_back(static_cast<float>(*value));
        of_vertex.push_back(*value);
        if (of_vertex.size() != 4 || of_vertex[3] == 0) continue;
        for (std::size_t i = 0; i < 3; ++i)
            numbers.push_back(static_cast<float>(of_vertex[i] / of_vertex[3]));
    }
    std::ranges::sort(numbers);
    return numbers;
}

bool holds(const std::vector<float>& numbers, float x) {
    const auto above = std::ranges::lower_bound(numbers, x);
    const float room = 1e-6F * std::abs(x);
    return (above != numbers.end() && std::abs(*above - x) <= room) ||
           (above != numbers.begin() && std::abs(*(above - 1) - x) <= room);
}

/// Every coordinate is written in the file, or is a quotient of what is.
void require_written(const TriangleMesh& mesh, const std::string& text) {
    const std::vector<float> numbers = numbers_of(text);
    for (const Vec3& position : mesh.positions)
        for (const float x : position) {
            if (!holds(numbers, x)) fuzz::fail("the file has no coordinate " + std::to_string(x));
        }
}

}  // namespace

const std::vector<std::string>& caustics::fuzz::words() {
    static const std::vector<std::string> all = {
        "v",    "vt",     "vn",     "vp",   "f",    "l",        "p",    "o", "g",  "s",
        "off",  "usemtl", "mtllib", "curv", "surf", "cstype",   "fo",   "#", "\\", "\\\n",
        "\r\n", "1/1/1",  "1//1",   "1/1",  "-1",   "-1/-1/-1", "2//2", "/"};
    return all;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(fuzz::view(data, size));
    TriangleMesh mesh;
    // A comment may cut a word short.
    if (fuzz::read_mesh("mesh.obj", text, read_obj, mesh) && fuzz::one_in(8, text) &&
        text.find('#') == std::string::npos)
        require_written(mesh, text);
    return 0;
}
