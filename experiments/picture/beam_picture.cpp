#include "experiments/picture/beam_picture.h"

#include <algorithm>
#include <cmath>

#include "beamtree/beam_tree.h"
#include "beamtree/beam_tree_method.h"
#include "beamtree/caustic_edges.h"
#include "core/render/renderer.h"

namespace caustics::experiments {

namespace {

constexpr double dimmed = -0.5;  // of the picture behind [stops]

struct Pen {
    beamtree::CausticEdge::Kind kind;
    std::array<double, 3> colour;
    double cover;  ///< of what is below, in the middle of the line
};

// In the order in which they are drawn.
const std::array<Pen, 3> pens = {{{beamtree::CausticEdge::Kind::direct, {255, 140, 20}, 0.55},
                                  {beamtree::CausticEdge::Kind::folded, {40, 160, 255}, 0.7},
                                  {beamtree::CausticEdge::Kind::fold, {255, 255, 255}, 1}}};

void mix(Picture& picture, int x, int y, const Pen& pen, double share) {
    if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
        static_cast<std::size_t>(x);
    const double cover = share * pen.cover;
    for (std::size_t i = 0; i < 3; ++i) {
        unsigned char& value = picture.rgb[3 * pixel + i];
        value = static_cast<unsigned char>(
            std::lround((1 - cover) * static_cast<double>(value) + cover * pen.colour[i]));
    }
}

// A line one pixel wide, by the two pixels beside it at each step along its longer way.
void draw_line(Picture& picture, Vec2d from, Vec2d to, const Pen& pen) {
    const bool steep = std::abs(to.y() - from.y()) > std::abs(to.x() - from.x());
    if (steep) {
        std::swap(from.x(), from.y());
        std::swap(to.x(), to.y());
    }
    if (from.x() > to.x()) std::swap(from, to);
    const double slope = to.x() > from.x() ? (to.y() - from.y()) / (to.x() - from.x()) : 0;
    for (int x = static_cast<int>(from.x()); x <= static_cast<int>(to.x()); ++x) {
        const double at = std::clamp(x + 0.5, from.x(), to.x());
        const double y = from.y() + slope * (at - from.x()) - 0.5;
        const int low = static_cast<int>(std::floor(y));
        const double above = y - low;
        mix(picture, steep ? low : x, steep ? x : low, pen, 1 - above);
        mix(picture, steep ? low + 1 : x, steep ? x : low + 1, pen, above);
    }
}

/// Where the camera sees points directly.
class View {
public:
    explicit View(const Scene& scene)
        : scene_(scene), film_(scene.camera()), eye_(scene.camera().position()) {}

    std::optional<Vec2d> place(const Vec3& p) const {
        const auto seen = film_.project(p);
        if (!seen) return {};
        const auto hit = scene_.intersect(spawn_ray({eye_}, (p - eye_).normalized()));
        if (!hit || hit->distance < 0.999F * (p - eye_).norm()) return {};
        return Vec2d(seen->x, seen->y);
    }

private:
    const Scene& scene_;
    FilmProjection film_;
    Vec3 eye_;
};

}  // namespace

Picture draw_beams(const Scene& scene, const JsonNode& node, const RunOptions& options) {
    const beamtree::BeamTreeParams params = beamtree::beamtree_method().read(node);
    const Film film = render(scene, *build(scene, params, options), options).film;
    Picture picture = tone_map(film, "", auto_exposure(film, "") + dimmed);
    const beamtree::TracedScene traced = beamtree::trace_scene(scene, "beams", params, options);
    const std::vector<beamtree::CausticEdge> edges = beamtree::caustic_edges(scene, traced);
    const View view(scene);
    for (const Pen& pen : pens)
        for (const beamtree::CausticEdge& edge : edges) {
            if (edge.kind != pen.kind) continue;
            const auto from = view.place(edge.from);
            const auto to = view.place(edge.to);
            if (from && to) draw_line(picture, *from, *to, pen);
        }
    return picture;
}

}  // namespace caustics::experiments
