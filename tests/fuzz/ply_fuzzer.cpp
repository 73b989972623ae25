#include "core/mesh/ply_mesh.h"
#include "tests/fuzz/mesh_checks.h"
#include "tests/fuzz/word_hooks.h"

const std::vector<std::string>& caustics::fuzz::words() {
    static const std::vector<std::string> all = {"ply",
                                                 "format",
                                                 "ascii",
                                                 "binary_little_endian",
                                                 "binary_big_endian",
                                                 "1.0",
                                                 "element",
                                                 "vertex",
                                                 "face",
                                                 "property",
                                                 "list",
                                                 "char",
                                                 "uchar",
                                                 "short",
                                                 "ushort",
                                                 "int",
                                                 "uint",
                                                 "float",
                                                 "double",
                                                 "int8",
                                                 "uint8",
                                                 "int16",
                                                 "uint16",
                                                 "int32",
                                                 "uint32",
                                                 "float32",
                                                 "float64",
                                                 "x",
                                                 "y",
                                                 "z",
                                                 "nx",
                                                 "ny",
                                                 "nz",
                                                 "u",
                                                 "v",
                                                 "s",
                                                 "t",
                                                 "texture_u",
                                                 "texture_v",
                                                 "vertex_indices",
                                                 "vertex_index",
                                                 "comment",
                                                 "obj_info",
                                                 "end_header",
                                                 "\r\n"};
    return all;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace caustics;
    TriangleMesh mesh;
    fuzz::read_mesh("mesh.ply", std::string(fuzz::view(data, size)), read_ply, mesh);
    return 0;
}
