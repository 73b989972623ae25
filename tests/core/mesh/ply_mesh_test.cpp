#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "tests/core/mesh/mesh_files.h"

namespace caustics {
namespace {

using test::ascii_ply;
using test::binary_ply;
using test::expect_same;
using test::PlyContent;

class PlyMesh : public test::MeshFiles {};

/// Awkward values: all digits, signs, tiny, huge, and the bytes of a line end in front.
PlyContent awkward() {
    PlyContent ply;
    ply.columns = {"x", "y", "z", "nx", "ny", "nz", "u", "v"};
    const auto newline = std::bit_cast<float>(std::uint32_t{0x0A0A0A0A});
    const auto little_newline = std::bit_cast<float>(std::uint32_t{0x3F800D0A});
    ply.rows = {{newline, -0.1F, 0.3F, 0, 0, 1, 0.25F, 0.75F},
                {1.0000001F, 16777217.F, -3.3333333F, 0.1F, 0.2F, 3, 0, 1},
                {little_newline, 1e-30F, 12345.679F, 0, -1, 0, 1, 0},
                {-7.7777777F, 1.1754944e-38F, 3.3e8F, 1, 1, 1, 0.1F, 0.9F},
                {0.2F, 0.7F, 0.9F, 1, 0, 0, 0.3F, 0.3F}};
    ply.polygons = {{0, 1, 2}, {0, 2, 3, 4}, {4, 3, 2, 1, 0}};
    return ply;
}

PlyContent square() {
    PlyContent ply;
    ply.rows = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    ply.polygons = {{0, 1, 2, 3}};
    return ply;
}

TEST_F(PlyMesh, ThreePlyEncodingsAreTheSameMeshBitForBit) {
    const PlyContent ply = awkward();
    const TriangleMesh ascii = load("a.ply", ascii_ply(ply));
    expect_same(ascii, load("l.ply", binary_ply(ply, false)));
    expect_same(ascii, load("b.ply", binary_ply(ply, true)));

    ASSERT_EQ(ascii.positions.size(), ply.rows.size());
    for (std::size_t i = 0; i < ply.rows.size(); ++i) {
        EXPECT_EQ(ascii.positions[i], Vec3(ply.rows[i][0], ply.rows[i][1], ply.rows[i][2]));
        EXPECT_EQ(ascii.uvs[i], Vec2(ply.rows[i][6], ply.rows[i][7]));
        EXPECT_NEAR(ascii.normals[i].norm(), 1, 2e-7);
    }
    EXPECT_EQ(ascii.triangles.size(), 6U);
}

TEST_F(PlyMesh, ThreePlyEncodingsAgreeWithoutNormalsToo) {
    const PlyContent ply = square();
    const TriangleMesh ascii = load("a.ply", ascii_ply(ply));
    expect_same(ascii, load("l.ply", binary_ply(ply, false)));
    expect_same(ascii, load("b.ply", binary_ply(ply, true)));
    for (const Vec3& normal : ascii.normals) EXPECT_EQ(normal, Vec3(0, 0, 1));
}

TEST_F(PlyMesh, PlyTypesOfListsAndValuesDoNotMatter) {
    const TriangleMesh expected = load("a.ply", ascii_ply(awkward()));
    for (const char* count_type : {"uchar", "ushort", "uint"})
        for (const char* index_type : {"uchar", "ushort", "int", "uint"})
            for (const char* value_type : {"float", "double"})
                for (const bool big_endian : {false, true}) {
                    PlyContent ply = awkward();
                    ply.count_type = count_type;
                    ply.index_type = index_type;
                    ply.value_type = value_type;
                    expect_same(expected, load("t.ply", binary_ply(ply, big_endian)));
                }
}

TEST_F(PlyMesh, PlyHeaderMayHaveDosLineEnds) {
    std::string bytes = binary_ply(square(), false);
    const std::size_t body = bytes.find("end_header\n") + 11;
    std::string dos;
    for (const char c : bytes.substr(0, body)) dos += c == '\n' ? "\r\n" : std::string(1, c);
    expect_same(load("l.ply", bytes), load("dos.ply", dos + bytes.substr(body)));
}

TEST_F(PlyMesh, OtherPlyElementsAndPropertiesAreSteppedOver) {
    const TriangleMesh mesh = load(
        "a.ply",
        "ply\nformat ascii 1.0\nelement junk 2\nproperty list uchar float f\nelement vertex 3\n"
        "property float z\nproperty uchar red\nproperty float y\nproperty float x\n"
        "element face 1\nproperty uchar flags\nproperty list uchar int vertex_index\n"
        "end_header\n2 1 2\n0\n9 1 8 7\n6 1 5 4\n3 1 2 1\n7 3 0 1 2\n");
    EXPECT_EQ(mesh.positions[0], Vec3(7, 8, 9));
    EXPECT_EQ(mesh.positions[2], Vec3(1, 2, 3));
    EXPECT_EQ(mesh.triangles.size(), 1U);
}

TEST_F(PlyMesh, IsReadAsOtherProgramsWriteIt) {
    const std::string text = ascii_ply(square());
    const TriangleMesh plain = load("a.ply", text);
    const auto with = [&](std::string changed, const std::string& what, const std::string& by) {
        return changed.replace(changed.find(what), what.size(), by);
    };
    for (const std::string name : {"vertex_index", "indices"})
        expect_same(plain, load("b.ply", with(text, "vertex_indices", name)));
    expect_same(plain, load("c.ply", with(text, "1 1 0", "+1 1.0D+0 0d0")));
}

TEST_F(PlyMesh, VerticesOfNoTriangleAreNoPartOfTheMesh) {
    const TriangleMesh mesh =
        load("u.ply",
             "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
             "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
             "element face 1\nproperty list uchar int vertex_index\nend_header\n"
             "1e5 0 0 1 0 0\n1 0 0 0 0 1\n0 2 0 0 0 1\n0 0 1e6 1 0 0\n0 0 0 0 0 1\n3 4 1 2\n");
    ASSERT_EQ(mesh.positions.size(), 3U);
    EXPECT_EQ(mesh.positions[0], Vec3(1, 0, 0));
    EXPECT_EQ(mesh.positions[2], Vec3(0, 0, 0));
    ASSERT_EQ(mesh.normals.size(), 3U);
    EXPECT_EQ(mesh.normals[2], Vec3(0, 0, 1));
    EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{2, 0, 1}));
}

TEST_F(PlyMesh, EveryTruncationOfAPlyIsRefused) {
    for (const std::string& whole :
         {binary_ply(awkward(), false), binary_ply(awkward(), true), ascii_ply(square())}) {
        // The last character of the ASCII file is only a line end.
        const std::size_t longest = whole.size() - (whole.find("ascii") < 20 ? 2 : 1);
        for (std::size_t size = 0; size <= longest; ++size)
            EXPECT_NE(refusal(write("cut.ply", whole.substr(0, size))), "accepted") << size;
    }
    const std::string whole = binary_ply(awkward(), false);
    expect_refused("cut.ply", whole.substr(0, whole.size() - 1),
                   "truncated: it ends inside face 2");
    expect_refused("long.ply", whole + '\0', "goes on after the last element");
    expect_refused("long.ply", ascii_ply(square()) + "3 0 1 2\n", "goes on after");
}

/// Which of the two is meant cannot be told.
TEST_F(PlyMesh, FacesHaveOneListOfCorners) {
    std::string bytes = ascii_ply(square());
    const std::string first = "vertex_indices\n";
    bytes.insert(bytes.find(first) + first.size(), "property list uchar int vertex_index\n");
    bytes.insert(bytes.rfind("4 0 1 2 3") + 9, " 3 2 1 0");
    expect_refused("a.ply", bytes, "faces have more than one list of corners (vertex_indices, ");
}

// A list `indices` beside a list of another of the names, before or after it, is of something else.
TEST_F(PlyMesh, AListOfIndicesBesideTheCornersIsSteppedOver) {
    const TriangleMesh plain = load("a.ply", ascii_ply(square()));
    for (const std::string name : {"vertex_indices", "vertex_index"})
        for (const bool first : {true, false}) {
            std::string bytes = ascii_ply(square());
            const std::size_t corners = bytes.find("property list");
            const std::size_t end = bytes.find("vertex_indices\n", corners);
            bytes.replace(end, 14, name);
            bytes.insert(first ? corners : end + name.size() + 1,
                         "property list uchar int indices\n");
            const std::size_t face = bytes.rfind("4 0 1 2 3");
            bytes.insert(first ? face : face + 9, first ? "2 7 8 " : " 2 7 8");
            expect_same(plain, load("b.ply", bytes));
        }
}

TEST_F(PlyMesh, BrokenPlyFilesAreRefusedWithTheReason) {
    const std::string good = ascii_ply(square());
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string bytes = good;
        const std::size_t at = bytes.rfind(from);
        EXPECT_NE(at, std::string::npos) << from;
        return bytes.replace(at, from.size(), to);
    };
    expect_refused("a.ply", with("4 0 1 2 3", "4 0 1 2 4"), "face 0: vertex 4 is not among the 4");
    expect_refused("a.ply", with("4 0 1 2 3", "4 0 1 2 -1"), "face 0");
    expect_refused("a.ply", with("4 0 1 2 3", "4 0 1 2 1.5"), "face 0");
    expect_refused("a.ply", with("4 0 1 2 3", "2 0 1"), "at least 3 corners, this one has 2");
    expect_refused("a.ply", with("4 0 1 2 3", "0"), "this one has 0");
    expect_refused("a.ply", with("4 0 1 2 3", "-4 0 1 2 3"), "face 0");
    expect_refused("a.ply", with("4 0 1 2 3", "nan 0 1 2 3"), "face 0");
    expect_refused("a.ply", with("4 0 1 2 3", "4000000000 0 1"), "truncated");
    expect_refused("a.ply", with("1 1 0", "1 nan 0"), "vertex 2: y is nan");
    expect_refused("a.ply", with("1 1 0", "1 1 inf"), "vertex 2: z is inf");
    expect_refused("a.ply", with("1 1 0", "1e39 1 0"), "vertex 2: x is 1e+39");
    expect_refused("a.ply", with("1 1 0", "1 one 0"), "'one' is not a number");
    expect_refused("a.ply", with("element vertex 4", "element vertex 5"), "inside face 0");
    expect_refused("a.ply", with("element vertex 4", "element vertex 3"), "face 0");
    expect_refused("a.ply", with("element vertex 4", "element vertex -4"),
                   "needs a name and a count");
    expect_refused("a.ply", with("element face 1", "element edge 1"), "no element 'face'");
    expect_refused("a.ply", with("element face 1", "element face 0"), "goes on");
    expect_refused("a.ply", with("property float z", "property float q"), "no x, y, z");
    expect_refused("a.ply", with("property float z", "property half z"), "unknown type");
    expect_refused("a.ply", with("vertex_indices", "corners"), "vertex_indices");
    expect_refused("a.ply", with("format ascii", "format morse"), "binary_big_endian");
    expect_refused("a.ply", with("format ascii 1.0\n", ""), "no format line");
    expect_refused("a.ply", with("element vertex", "format binary_big_endian 1.0\nelement vertex"),
                   "more than one format line");
    expect_refused("a.ply", with("property float y", "property float x\nproperty float y"),
                   "property 'x' is given twice");
    expect_refused(
        "a.ply", with("property float z", "property float z\nproperty float nx\nproperty float ny"),
        "normals need all of nx, ny, nz");
    expect_refused("a.ply", "solid stl\n", "not a PLY file");
    PlyContent nan = square();
    nan.rows[3][1] = std::nanf("");
    expect_refused("n.ply", binary_ply(nan, false), "vertex 3: y is");
    expect_refused("n.ply", binary_ply(nan, true), "vertex 3: y is");
}

// Names are not each held against all others, which takes minutes.
TEST_F(PlyMesh, FindsWhatIsGivenTwiceAmongManyProperties) {
    std::string header = "ply\nformat ascii 1.0\nelement vertex 0\n";
    for (int i = 0; i < 100'000; ++i) header += "property float p" + std::to_string(i) + "\n";
    expect_refused("many.ply", header + "property int p7\nend_header\n",
                   "property 'p7' is given twice");
}

}  // namespace
}  // namespace caustics
