#include "tests/fuzz/mesh_checks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace caustics;
    const auto file = fuzz::put("mesh.ply", fuzz::view(data, size));
    TriangleMesh mesh;
    fuzz::read_mesh(file, mesh);
    return 0;
}
