#include "beamtree/light/root_beams.h"

#include "beamtree/light/cut_triangles.h"
#include "beamtree/light/first_polygon.h"
#include "beamtree/light/root_divider.h"
#include "core/base/parallel.h"

namespace caustics::beamtree {
namespace {

constexpr int most_root_quarters = 3;
constexpr std::size_t root_beams_together = 256;  // that threads take at a time

/// Prepares the beams of a set.
class RootPreparation {
public:
    RootPreparation(const Scene& scene, const TriangleMesh& polygons,
                    const std::vector<RayOrigin>& origins, const BeamSet& set)
        : scene_(scene),
          set_(set),
          chain_(scene, set),
          exact_(first_exact_surface(scene, set)),
          cut_(exact_ ? CutTriangles(polygons, origins, set,
                                     [this](CutTriangles::Whole& whole) { return find_lit(whole); })
                      : CutTriangles(set)),
          reach_(static_cast<double>(scene.diameter())),
          meets_mesh_(meets_mesh_after_first(scene, set)) {}

    RootBeams run(const Chunk& beams) const {
        RootBeams out;
        for (auto i = static_cast<std::uint32_t>(beams.first); i < beams.end; ++i) prepare(i, out);
        return out;
    }

private:
    void prepare(std::uint32_t number, RootBeams& out) const {
        for (const CutTriangles::Whole& whole : cut_.after(number)) add_cut(whole, number, out);
        if (cut_.has(number)) return;
        const Beam& beam = set_.beams[number];
        const std::size_t count = beam.triangle_count();
        const std::size_t before = out.beams.size();
        const std::size_t rays_before = out.rays.size();
        for (std::size_t which = 0; which < count; ++which) divide(number, which, out);
        if (count == 1 || out.rays.size() > rays_before) return;
        // A cell that need not be divided stays one.
        RootBeam cell{.beam = beam, .from = number};
        for (std::size_t which = 0; which < count; ++which)
            cell.middles[which] = out.beams[before + which].middles[0];
        out.beams.resize(before);
        out.beams.push_back(cell);
    }

    FirstPolygon polygon(const CutTriangles::Whole& whole) const {
        return {scene_, set_, exact_, whole.beam, 0, whole.corners};
    }
    bool find_lit(CutTriangles::Whole& whole) const {
        const FirstPolygon triangle = polygon(whole);
        const std::array<Vec2d, 4> places = {triangle.coordinates(whole.middle), unit_corners[0],
                                             unit_corners[1], unit_corners[2]};
        bool is_lit = false;
        bool has_dark = false;
        for (const Vec2d& at : places) {
            const bool lit = chain_.ray(triangle.start(at)).has_value();
            if (lit && !is_lit) whole.lit = at;
            is_lit = is_lit || lit;
            has_dark = has_dark || !lit;
        }
        return is_lit && (has_dark || whole.is_covered);
    }
    void add_cut(const CutTriangles::Whole& whole, std::uint32_t number, RootBeams& out) const {
        const FirstPolygon triangle = polygon(whole);
        divider(triangle, out)
            .add_cut({.beam = whole.beam, .from = number, .is_part = true}, whole.corners,
                     whole.lit);
    }
    RootDivider divider(const FirstPolygon& polygon, RootBeams& out) const {
        return {chain_, polygon, reach_, meets_mesh_, static_cast<std::uint32_t>(set_.rays.size()),
                out};
    }

    void divide(std::uint32_t number, std::size_t which, RootBeams& out) const {
        const Beam& beam = set_.beams[number];
        const std::array<std::uint32_t, 3> rays = beam.triangle_corners(which);
        std::array<RootNode, 3> corners;
        for (std::size_t i = 0; i < 3; ++i)
            corners[i] = {.at = unit_corners[i],
                          .origin = set_.origin(rays[i]),
                          .ray = set_.rays[rays[i]],
                          .number = rays[i]};
        RootBeam whole{.beam = beam, .from = number, .is_part = beam.triangle_count() > 1};
        whole.beam.flux *= static_cast<float>(beam.share_of(which));
        whole.beam.first_share = 1;
        whole.beam.triangle = beam.mesh_triangle(which);
        whole.beam.is_cell = false;
        whole.beam.corners[3] = Beam::none;
        const FirstPolygon polygon(scene_, set_, exact_, beam, which);
        RootDivider dividing = divider(polygon, out);
        if (meets_mesh_ && dividing.take_own_rays(corners)) whole.is_part = true;
        dividing.divide(corners, whole, most_root_quarters);
    }

    const Scene& scene_;
    const BeamSet& set_;
    LightChain chain_;
    std::optional<SpecularSurface> exact_;
    CutTriangles cut_;
    double reach_;
    bool meets_mesh_;
};

/// Puts prepared beams in the place of a set's.
class RootJoin {
public:
    explicit RootJoin(BeamSet& set) : set_(set), new_number_(set.beams.size(), Beam::none) {
        set_.beams.clear();
        set_.middles.clear();
    }

    void add(const RootBeams& some, std::size_t old_rays) {
        const auto moved = static_cast<std::uint32_t>(set_.rays.size() - old_rays);
        for (const RootBeam& each : some.beams) {
            if (!each.is_part)
                new_number_[each.from] = static_cast<std::uint32_t>(set_.beams.size());
            from_.push_back(each.is_part ? Beam::none : each.from);
            Beam& beam = set_.beams.emplace_back(each.beam);
            for (std::uint32_t& corner : beam.corners)
                if (corner != Beam::none && corner >= old_rays) corner += moved;
            for (std::size_t i = 0; i < set_.triangle_room; ++i)
                set_.middles.push_back(each.middles[i]);
        }
        set_.rays.insert(set_.rays.end(), some.rays.begin(), some.rays.end());
        if (!set_.origins.empty())
            set_.origins.insert(set_.origins.end(), some.origins.begin(), some.origins.end());
    }

    // Parts have no partners, and new rays no spreads.
    void finish() {
        if (!set_.spreads.empty()) set_.spreads.resize(set_.rays.size());
        if (set_.partners.empty()) return;
        std::vector<std::uint32_t> partners(set_.beams.size(), Beam::none);
        for (std::size_t i = 0; i < partners.size(); ++i) {
            if (from_[i] == Beam::none) continue;
            const std::uint32_t partner = set_.partners[from_[i]];
            if (partner != Beam::none) partners[i] = new_number_[partner];
        }
        set_.partners = std::move(partners);
    }

private:
    BeamSet& set_;
    std::vector<std::uint32_t> new_number_;  ///< one an old beam; none where it was divided
    std::vector<std::uint32_t> from_;        ///< one a beam: the old one, unless it is a part
};

bool comes_to_front(const LightSample& light, const std::vector<RayOrigin>& origins,
                    const Beam& beam) {
    float slant = 0;
    for (const std::uint32_t corner : beam.triangle_corners(0))
        slant += origins[corner].normal.dot(to_light(light, origins[corner].position));
    return slant > 0;
}

}  // namespace

void prepare_roots(const Scene& scene, const TriangleMesh& polygons,
                   const std::vector<RayOrigin>& origins, int threads, BeamSet& set) {
    if (set.beams.empty()) return;
    for (Beam& beam : set.beams) beam.front = comes_to_front(set.light, origins, beam);
    if (set.path.size() > 1)
        for (const RayOrigin& origin : origins) set.origins.push_back(origin.position);
    std::vector<RootBeams> chunks(chunk_count(set.beams.size(), root_beams_together));
    const RootPreparation preparation(scene, polygons, origins, set);
    parallel_chunks(threads, set.beams.size(), root_beams_together,
                    [&](const Chunk& chunk) { chunks[chunk.index] = preparation.run(chunk); });
    const bool divides =
        std::ranges::any_of(chunks, [](const RootBeams& some) { return !some.rays.empty(); });
    if (divides && set.origins.empty())
        for (const VertexRay& ray : set.rays) set.origins.push_back(ray.position);
    const bool has_cells =
        std::ranges::any_of(set.beams, [](const Beam& beam) { return beam.triangle_count() > 1; });
    set.triangle_room = has_cells ? 2 : 1;
    const std::size_t old_rays = set.rays.size();
    RootJoin join(set);
    for (const RootBeams& some : chunks) join.add(some, old_rays);
    join.finish();
}

}  // namespace caustics::beamtree
