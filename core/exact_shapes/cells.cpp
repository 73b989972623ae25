#include "core/exact_shapes/cells.h"

#include <string>

#include "core/base/error.h"

namespace caustics {
namespace {

constexpr int max_resolution = 16384;

}  // namespace

void check_resolution(int n, int least) {
    if (n < least || n > max_resolution)
        throw InputError("resolution " + std::to_string(n) + " is not in [" +
                         std::to_string(least) + ", " + std::to_string(max_resolution) + "]");
}

void check_resolution(Cells n) {
    check_resolution(n.x, 1);
    check_resolution(n.y, 1);
}

}  // namespace caustics
