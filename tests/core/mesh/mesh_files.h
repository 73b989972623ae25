#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/mesh/mesh_io.h"

namespace caustics::test {

/// Writes mesh files into a folder of the test's own and loads them.
class MeshFiles : public testing::Test {
protected:
    MeshFiles() {
        const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::path(testing::TempDir()) /
                  ("causticbench_mesh_" + std::to_string(::getpid()) + "_" + test->name());
        std::filesystem::create_directories(folder_);
    }
    ~MeshFiles() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return folder_ / name;
    }
    TriangleMesh load(const std::string& name, const std::string& bytes,
                      const MeshLoadOptions& options = {}) const {
        return load_mesh(write(name, bytes), options);
    }
    /// What is said of a broken file: one line that names it.
    std::string refusal(const std::filesystem::path& file) const {
        try {
            load_mesh(file, {});
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_EQ(message.rfind(file.string(), 0), 0U) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
            return message.substr(std::min(message.size(), file.string().size()));
        }
        return "accepted";
    }
    void expect_refused(const std::string& name, const std::string& bytes,
                        const std::string& reason) const {
        const std::string message = refusal(write(name, bytes));
        EXPECT_NE(message.find(reason), std::string::npos) << message << " / " << bytes;
    }

    std::filesystem::path folder_;
};

/// A mesh as PLY holds it: rows of vertex values and polygons.
struct PlyContent {
    std::vector<std::string> columns = {"x", "y", "z"};
    std::vector<std::vector<float>> rows;
    std::vector<std::vector<std::uint32_t>> polygons;
    std::string count_type = "uchar";
    std::string index_type = "int";
    std::string value_type = "float";
};

inline std::string header(const PlyContent& ply, const std::string& format) {
    std::string text = "ply\nformat " + format + " 1.0\ncomment made for a test\nelement vertex " +
                       std::to_string(ply.rows.size()) + "\n";
    for (const std::string& column : ply.columns)
        text += "property " + ply.value_type + " " + column + "\n";
    return text + "comment between elements\nelement face " + std::to_string(ply.polygons.size()) +
           "\nproperty list " + ply.count_type + " " + ply.index_type +
           " vertex_indices\nend_header\n";
}

inline std::string ascii_ply(const PlyContent& ply) {
    std::ostringstream text;
    text.precision(9);
    for (const auto& row : ply.rows) {
        for (const float value : row) text << value << ' ';
        text << '\n';
    }
    for (const auto& polygon : ply.polygons) {
        text << polygon.size();
        for (const std::uint32_t corner : polygon) text << ' ' << corner;
        text << '\n';
    }
    return header(ply, "ascii") + text.str();
}

template <class Value>
void put(std::string& out, Value value, bool big_endian) {
    auto raw = std::bit_cast<std::array<char, sizeof(Value)>>(value);
    if (big_endian) std::reverse(raw.begin(), raw.end());
    out.append(raw.data(), raw.size());
}

inline void put_integer(std::string& out, std::size_t value, const std::string& type,
                        bool big_endian) {
    if (type == "uchar") put(out, static_cast<std::uint8_t>(value), big_endian);
    if (type == "ushort") put(out, static_cast<std::uint16_t>(value), big_endian);
    if (type == "int" || type == "uint") put(out, static_cast<std::uint32_t>(value), big_endian);
}

inline std::string binary_ply(const PlyContent& ply, bool big_endian) {
    std::string out = header(ply, big_endian ? "binary_big_endian" : "binary_little_endian");
    for (const auto& row : ply.rows)
        for (const float value : row) {
            if (ply.value_type == "double")
                put(out, static_cast<double>(value), big_endian);
            else
                put(out, value, big_endian);
        }
    for (const auto& polygon : ply.polygons) {
        put_integer(out, polygon.size(), ply.count_type, big_endian);
        for (const std::uint32_t corner : polygon)
            put_integer(out, corner, ply.index_type, big_endian);
    }
    return out;
}

template <class Vector>
void expect_same_bits(const std::vector<Vector>& a, const std::vector<Vector>& b) {
    ASSERT_EQ(a.size(), b.size());
    if (!a.empty()) {
        EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Vector)), 0);
    }
}

inline void expect_same(const TriangleMesh& a, const TriangleMesh& b) {
    expect_same_bits(a.positions, b.positions);
    expect_same_bits(a.normals, b.normals);
    expect_same_bits(a.uvs, b.uvs);
    EXPECT_EQ(a.triangles, b.triangles);
}

}  // namespace caustics::test
