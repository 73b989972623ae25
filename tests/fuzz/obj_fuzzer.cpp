#include <algorithm>
#include <charconv>
#include <sstream>

#include "core/mesh/obj_mesh.h"
#include "tests/fuzz/mesh_checks.h"
#include "tests/fuzz/word_hooks.h"

namespace {

using namespace caustics;

/// The numbers among the words, in their order.
std::vector<float> numbers_of(const std::string& text) {
    std::vector<float> numbers;
    std::istringstream in(text);
    for (std::string word; in >> word;) {
        double value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error == std::errc{} && std::isfinite(value))
            numbers.push_back(static_cast<float>(value));
    }
    std::ranges::sort(numbers);
    return numbers;
}

/// Every coordinate is written in the file.
void require_written(const TriangleMesh& mesh, const std::string& text) {
    const std::vector<float> numbers = numbers_of(text);
    for (const Vec3& position : mesh.positions)
        for (const float x : position) {
            const auto above = std::ranges::lower_bound(numbers, x);
            const bool found =
                (above != numbers.end() && *above == x) ||
                (above != numbers.end() && std::abs(*above - x) <= 1e-6F * std::abs(x)) ||
                (above != numbers.begin() && std::abs(*(above - 1) - x) <= 1e-6F * std::abs(x));
            if (!found) fuzz::fail("the file has no coordinate " + std::to_string(x));
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
