#pragma once

namespace caustics {

/// Cells of a mesh along x and y; one number is for both.
struct Cells {
    // Implicit: a number stands for both.
    Cells(int both) : x(both), y(both) {}
    Cells(int along_x, int along_y) : x(along_x), y(along_y) {}
    int x, y;
};

/// Throws InputError unless least <= n <= 16384, which keeps vertex numbers far within 32 bits.
void check_resolution(int n, int least);
void check_resolution(Cells n);

}  // namespace caustics
