#pragma once

#include <cstddef>
#include <string>

namespace caustics {

/// The geometry of a mesh file, every number and index checked, in the plainest form of its own
/// file format: what is left for the library to read is what it reads without fault.
///
/// assimp 5.2 and 5.4 crash on binary PLY files that end early, make up the end of ASCII ones, take
/// a first data byte 0x0A or a CRLF header for a blank line (assimp issues 5341 and 2534), stop at
/// a comment between elements (4866), let indices out of range through, and read misspelt OBJ
/// numbers as 0. None of this reaches it in this form.
struct MeshSource {
    std::string text;           ///< the file to hand over
    std::size_t triangles = 0;  ///< that its polygons make, sum of (corners - 2)
};

/// `bytes` is a whole PLY file: ASCII, little- or big-endian. Result: binary, little-endian, with
/// elements `vertex` (positions; normals and u, v where given) and `face`. Other elements and
/// properties are left out. Throws InputError, one line beginning with `name`.
MeshSource check_ply(const std::string& bytes, const std::string& name);

/// `bytes` is a whole OBJ file. Result: its v, vt, vn and f lines. Names, groups, smoothing groups,
/// materials, points and lines are left out; free-form curves and surfaces are refused. Throws
/// InputError, one line beginning with `name` and the line's number.
MeshSource check_obj(const std::string& bytes, const std::string& name);

/// A word of a file, for a message: in quotes, cut to 40 characters, what cannot be printed as '?'.
std::string quoted(const std::string& word);

}  // namespace caustics
