#include "experiments/export/mesh_bytes.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>

namespace caustics::experiments {

namespace {

static_assert(std::endian::native == std::endian::little, "files are written as memory holds them");

template <class Value>
void append_bytes(std::string& bytes, const Value& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class Vector>
void append_vector(std::string& bytes, const Vector& v) {
    for (Eigen::Index i = 0; i < v.size(); ++i) append_bytes(bytes, v[i]);
}

}  // namespace

std::string ply_bytes(const TriangleMesh& mesh) {
    const bool normals = !mesh.normals.empty();
    const bool uvs = !mesh.uvs.empty();
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
        "property float x\nproperty float y\nproperty float z\n{}{}"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions.size(),
        normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
        uvs ? "property float u\nproperty float v\n" : "", mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        append_vector(bytes, mesh.positions[i]);
        if (normals) append_vector(bytes, mesh.normals[i]);
        if (uvs) append_vector(bytes, mesh.uvs[i]);
    }
    for (const auto& triangle : mesh.triangles) {
        append_bytes(bytes, std::uint8_t{3});
        for (const std::uint32_t corner : triangle) append_bytes(bytes, corner);
    }
    return bytes;
}

std::string pfm_bytes(const Bitmap& bitmap) {
    std::string bytes = fmt::format("PF\n{} {}\n-1.0\n", bitmap.width, bitmap.height);
    const auto width = static_cast<std::size_t>(bitmap.width);
    for (auto row = static_cast<std::size_t>(bitmap.height); row-- > 0;)
        for (std::size_t column = 0; column < width; ++column)
            append_vector(bytes, bitmap.texels[row * width + column]);
    return bytes;
}

}  // namespace caustics::experiments
