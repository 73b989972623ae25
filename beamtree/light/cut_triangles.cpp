#include "beamtree/light/cut_triangles.h"

#include <algorithm>

namespace caustics::beamtree {
namespace {

constexpr std::size_t most_pieces = 4;
constexpr double nearly_whole = 0.9999;  // of the area, with rounding
constexpr double on_edge = 1e-4;         // barycentric

/// A triangle of a mesh in double.
class MeshTriangle {
public:
    MeshTriangle(const TriangleMesh& mesh, std::uint32_t triangle) {
        const auto& [i, j, k] = mesh.triangles[triangle];
        a_ = mesh.positions[i].cast<double>();
        u_ = mesh.positions[j].cast<double>() - a_;
        v_ = mesh.positions[k].cast<double>() - a_;
        normal_ = u_.cross(v_);
    }
    double double_area() const { return normal_.norm(); }
    bool has_on_edge(const Vec3& position) const {
        const Vec3d way = position.cast<double>() - a_;
        const double u = normal_.dot(way.cross(v_)) / normal_.squaredNorm();
        const double v = normal_.dot(u_.cross(way)) / normal_.squaredNorm();
        return std::min({u, v, 1 - u - v}) <= on_edge;
    }

private:
    Vec3d a_, u_, v_, normal_;
};

/// Beams in a row that are pieces of one triangle.
struct Pieces {
    double double_area = 0;
    Vec3d middle = Vec3d::Zero();
    Spectrum flux = black();
    float offset = 0;
    bool are_at_edges = true;

    void add(const MeshTriangle& triangle, const Beam& beam,
             const std::vector<RayOrigin>& origins) {
        flux += beam.flux;
        offset = std::max(offset, beam.offset);
        for (std::size_t which = 0; which < beam.triangle_count(); ++which) {
            std::array<Vec3d, 3> corners;
            for (std::size_t i = 0; i < 3; ++i) {
                const Vec3& origin = origins[beam.triangle_corners(which)[i]].position;
                corners[i] = origin.cast<double>();
                are_at_edges = are_at_edges && triangle.has_on_edge(origin);
            }
            const double area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
            double_area += area;
            middle += area / 3 * (corners[0] + corners[1] + corners[2]);
        }
    }
};

CutTriangles::Whole whole_triangle(const TriangleMesh& mesh, std::uint32_t triangle,
                                   const Beam& like) {
    const auto& [i, j, k] = mesh.triangles[triangle];
    CutTriangles::Whole whole{
        .beam = like,
        .corners = {mesh.positions[i], mesh.positions[j], mesh.positions[k]},
        .middle = ((mesh.positions[i] + mesh.positions[j] + mesh.positions[k]) / 3).cast<double>(),
        .is_covered = false};
    whole.beam.corners.fill(Beam::none);
    whole.beam.flux = black();
    whole.beam.first_share = 1;
    whole.beam.triangle = triangle;
    whole.beam.is_cell = false;
    return whole;
}

/// The triangles of a mesh that a set's beams cover.
struct Coverage {
    std::vector<bool> triangles;
    std::vector<std::uint32_t> beam_at;  ///< one a vertex: the first beam on a triangle there

    Coverage(const TriangleMesh& mesh, const BeamSet& set)
        : triangles(mesh.triangles.size(), false), beam_at(mesh.positions.size(), Beam::none) {
        for (std::size_t i = 0; i < set.beams.size(); ++i)
            for (std::uint32_t k = 0; k < (set.beams[i].is_cell ? 2U : 1U); ++k) {
                const std::uint32_t triangle = set.beams[i].triangle + k;
                triangles[triangle] = true;
                for (const std::uint32_t vertex : mesh.triangles[triangle])
                    beam_at[vertex] = std::min(beam_at[vertex], static_cast<std::uint32_t>(i));
            }
    }
};

}  // namespace

CutTriangles::CutTriangles(const TriangleMesh& mesh, const std::vector<RayOrigin>& origins,
                           const BeamSet& set, const FindLit& find_lit)
    : CutTriangles(set) {
    const auto& beams = set.beams;
    std::uint32_t end = 0;
    for (std::uint32_t first = 0; first < beams.size(); first = end) {
        end = first + 1;
        if (beams[first].is_cell) continue;
        const auto is_piece = [&](const Beam& beam) {
            return !beam.is_cell && beam.triangle == beams[first].triangle;
        };
        while (end < beams.size() && is_piece(beams[end])) ++end;
        if (end - first > most_pieces) continue;
        const MeshTriangle triangle(mesh, beams[first].triangle);
        Pieces pieces;
        for (std::uint32_t i = first; i < end; ++i) pieces.add(triangle, beams[i], origins);
        if (!pieces.are_at_edges || !(pieces.double_area > 0) ||
            pieces.double_area >= nearly_whole * triangle.double_area())
            continue;
        Whole whole = whole_triangle(mesh, beams[first].triangle, beams[first]);
        whole.beam.flux = pieces.flux;
        whole.beam.offset = pieces.offset;
        whole.middle = pieces.middle / pieces.double_area;
        whole.is_covered = true;
        if (!find_lit(whole)) continue;
        std::fill(is_piece_.begin() + first, is_piece_.begin() + end, true);
        wholes_[first].push_back(whole);
    }
    const Coverage coverage(mesh, set);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        if (coverage.triangles[i]) continue;
        std::uint32_t beam = Beam::none;
        for (const std::uint32_t vertex : mesh.triangles[i])
            beam = std::min(beam, coverage.beam_at[vertex]);
        if (beam == Beam::none) continue;
        Whole whole = whole_triangle(mesh, i, beams[beam]);
        if (find_lit(whole)) wholes_[beam].push_back(whole);
    }
}

}  // namespace caustics::beamtree
