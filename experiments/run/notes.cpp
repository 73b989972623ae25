#include "experiments/run/notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <variant>

#include "core/light_path/aimed_emission.h"
#include "core/material/optics.h"
#include "core/mesh/vertex_normals.h"
#include "core/reference/sample_mean.h"
#include "core/scene/crossing_dielectrics.h"
#include "core/scene/eye_medium.h"
#include "core/scene/lights_on_casters.h"
#include "core/scene/media_conflicts.h"
#include "core/scene/shared_faces.h"
#include "experiments/run/wide_triangles.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;

constexpr double least_share_told = 0.01;

std::optional<double> resolved(const BuildReport& report, const char* name) {
    const auto found = report.resolved.find(name);
    if (found == report.resolved.end()) return {};
    return found->second;
}

// How many times its size a caster may lie from the origin of the scene's frame until roundings of
// coordinates change its light by 0.1 % (tests/agreement/far_scenes_test.cpp). The polygons of beams
// are far smaller than their caster.
constexpr double far_for_photons = 1000;
constexpr double far_for_beams = 10;

/// The caster that lies farthest from the frame's origin, in its own sizes, where that is beyond `most`.
std::optional<std::string> far_caster(const Scene& scene, double most) {
    std::optional<std::string> note;
    for (const std::uint32_t caster : scene.casters()) {
        const Shape& shape = scene.shapes()[caster];
        const Box box = bounds(shape);
        const auto times = static_cast<double>(box.center().norm() / box.diagonal().norm());
        if (!(times > most)) continue;
        most = times;
        note = fmt::format(
            "{} lies {:.2g} times its size from the other casters; its light is good to 0.1 % only "
            "within {} times (beams: {}): put casters so far apart into scenes of their own",
            shape.name, times, far_for_photons, far_for_beams);
    }
    return note;
}

bool has_area_light(const Scene& scene) {
    return std::ranges::any_of(scene.lights(), [](const Light& light) {
        return std::holds_alternative<AreaLight>(light);
    });
}

bool has_exact_receiver(const Scene& scene) {
    return std::ranges::any_of(scene.shapes(), [](const Shape& shape) {
        return shape.primitive != Primitive::mesh && is_receiver(shape.bsdf);
    });
}

bool has_dispersive_caster(const Scene& scene) {
    return std::ranges::any_of(scene.casters(), [&](std::uint32_t caster) {
        return is_dispersive(scene.shapes()[caster].bsdf);
    });
}

bool has_parameter(const Method& method, const std::string& key) {
    return std::ranges::any_of(method.description->parameters(),
                               [&](const KeyText& text) { return text.key == key; });
}

/// Beams of parts of the wavelengths draw a rainbow as so many pictures beside each other.
std::optional<std::string> steps_of_colour(const Scene& scene, const Method& method) {
    const std::vector<KeyText> texts = method.description->parameters();
    const auto parts = std::ranges::find(texts, "wavelengths", &KeyText::key);
    const json given = describe(method);
    if (parts == texts.end() || given.contains("dispersion") || !has_dispersive_caster(scene))
        return {};
    return fmt::format(
        "{} parts of the wavelengths stand for all: where colours spread, the edges of the "
        "parts are steps, and points beside them are off by tens of per cent (a larger wavelengths "
        "makes them smaller{})",
        given.contains("wavelengths") ? given.at("wavelengths").dump() : parts->usual,
        has_parameter(method, "dispersion") ? "; dispersion=intervals has none" : "");
}

/// Flat polygons stand for a curved receiver.
std::optional<std::string> flat_pieces(const Scene& scene, const Method& method) {
    const json given = describe(method);
    const auto pieces = given.find("receiver_resolution");
    if (pieces == given.end()) return {};
    for (const Shape& shape : scene.shapes())
        if (is_receiver(shape.bsdf) && !shape.radiance &&
            (shape.primitive == Primitive::sphere || shape.primitive == Primitive::cylinder))
            return fmt::format(
                "{} x {} flat polygons stand for the curved receiver {}: its light is that of "
                "their planes, off by 10 % and more where they are few (receiver_resolution)",
                pieces->dump(), pieces->dump(), shape.name);
    return {};
}

/// Beams on a mesh of glass are bent as its triangles' corners are; between those of a flat facet `refined` knows how.
std::optional<std::string> coarse_glass(const Scene& scene, const Method& method) {
    constexpr double degree = pi_d / 180;
    const bool by_area = describe(method).value("intensity", "area") == "area";
    const auto wide = wide_triangles(
        scene, by_area ? Triangles::all : Triangles::of_changing_normals, 5 * degree);
    if (!wide) return {};
    return fmt::format(
        "a light sees {} in triangles {:.0f} degrees wide: behind its second surface beams are "
        "bent as the corners of a polygon are, so that their light is off by several per cent at "
        "points (triangles half as wide halve that{}; photonmap sees every ray's own way)",
        wide->shape, wide->angle / degree,
        by_area && has_parameter(method, "intensity")
            ? "; intensity=refined knows what lies between those of a flat one"
            : "");
}

std::optional<std::string> thin_walls(const BuildReport& report) {
    const double share = resolved(report, "walls_behind_polygons").value_or(0);
    if (share < least_share_told) return {};
    constexpr double most_told = 16;  // beyond, or where surfaces are at one place, no mesh serves
    const double finer = std::ceil(resolved(report, "walls_need_finer").value_or(1));
    return fmt::format(
        "another surface lies so close below a curved caster that {:.0f} % of the polygons that "
        "stand for it reach it, or nearly: light of beams that goes through such thin walls is not "
        "to be trusted (take {}photonmap, which sees the shapes themselves)",
        100 * share,
        finer > most_told ? "" : fmt::format("a mesh_resolution {:.0f} times as fine, or ", finer));
}

/// That a note which names one pair is of others, too.
std::string of_more_pairs(std::size_t pairs, const char* at_least = "") {
    if (pairs == 1) return "";
    if (pairs == 2) return " (and 1 pair more)";
    return fmt::format(" (and {} pairs more{})", pairs - 1, at_least);
}

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

std::optional<std::string> what_crosses(const Scene& scene, const Pairs& pairs) {
    if (pairs.empty()) return {};
    return fmt::format(
        "the dielectrics {} and {}{} cross: which medium is inside both is not known, and light "
        "that "
        "comes there is not to be trusted",
        scene.shapes()[pairs[0].first].name, scene.shapes()[pairs[0].second].name,
        of_more_pairs(pairs.size(), pairs.size() < most_crossing_pairs ? "" : ", at least"));
}

/// But for those that cross, of which another note tells.
std::optional<std::string> what_disagrees(const Scene& scene, const Pairs& crossing) {
    std::vector<MediaConflict> conflicts = media_conflicts(scene);
    std::erase_if(conflicts, [&](const MediaConflict& each) {
        return std::ranges::count(crossing, std::pair(each.first, each.second)) > 0;
    });
    if (conflicts.empty()) return {};
    const MediaConflict& one = conflicts.front();
    const std::string what =
        one.first_ior == one.second_ior
            ? "what it absorbs"
            : fmt::format("n = {:.4g} and {:.4g}", one.first_ior, one.second_ior);
    return fmt::format(
        "the dielectrics {} and {}{} disagree on the medium between them, {}: light there goes as "
        "at no real pair (ext_ior and ext_absorption say what is round a dielectric)",
        scene.shapes()[one.first].name, scene.shapes()[one.second].name,
        of_more_pairs(conflicts.size()), what);
}

std::optional<std::string> what_shares_faces(const Scene& scene) {
    const auto faces = shared_faces(scene);
    if (faces.empty()) return {};
    return fmt::format(
        "{} lies with a face on {}{}: light that leaves one of the two steps over the other, and "
        "what "
        "comes there is not to be trusted (leave a gap of a ten-thousandth of the size, or make "
        "one "
        "surface of both)",
        scene.shapes()[faces[0].caster].name, scene.shapes()[faces[0].other].name,
        of_more_pairs(faces.size()));
}

std::string where_it_lies(const Scene& scene, const LightOnCaster& light) {
    const Vec3d at = scene.origin() + light.position.cast<double>();
    return fmt::format(
        "the light at ({:g}, {:g}, {:g}) lies on {}: on which of its sides it shines is not known, "
        "and "
        "the caustic, if there is one, is not to be trusted (move the light to one side, by a "
        "millionth of its coordinates or more)",
        at.x(), at.y(), at.z(), scene.shapes()[light.caster].name);
}

/// Parameters of a method that differ from its defaults.
class SetParameters {
public:
    explicit SetParameters(const Method& method)
        : values_(describe(method)),
          defaults_(describe(parse_method(method.name, parameters_node({})))) {}

    /// "name=value", or nothing where the method has its default or no such parameter.
    std::optional<std::string> find(const char* name) const {
        const auto value = values_.find(name);
        if (value == values_.end() || *value == defaults_.value(name, json())) return {};
        return fmt::format("{}={}", name,
                           value->is_string() ? value->get<std::string>() : value->dump());
    }

private:
    json values_;
    json defaults_;
};

/// From here on a smooth normal is a guess over a hard edge.
constexpr double hard_bend = 30 * pi_d / 180;

/// A caster, and by how much its smooth normals differ from its triangles.
struct BentCaster {
    std::string name;
    double bend = 0;  ///< [rad]

    std::string text() const {
        return fmt::format("{}, by up to {:.0f} degrees", name, bend * 180 / pi_d);
    }
};

std::vector<BentCaster> bent_casters(const Scene& scene) {
    std::vector<BentCaster> casters;
    for (const std::uint32_t i : scene.casters()) {
        const Shape& shape = scene.shapes()[i];
        casters.push_back({shape.name, largest_bend(shape.mesh)});
    }
    return casters;
}

void note_misdirected(const Scene& scene, const CausticLedger& ledger,
                      std::vector<std::string>& all) {
    const double share = ledger.light.misdirected / ledger.light.sent;
    if (share < least_share_told) return;
    const std::vector<BentCaster> casters = bent_casters(scene);
    const auto most = std::ranges::max_element(casters, {}, &BentCaster::bend);
    all.push_back(fmt::format(
        "{:.1f} % of the light on casters, and about as much of the caustic, is lost where smooth "
        "normals send it to the wrong side of a surface; the normals differ most from the "
        "triangles on {} "
        "(face_normals: true shades the triangles of a mesh flat; a finer resolution bends less)",
        100 * share, most->text()));
}

void note_photons(const BuildReport& report, std::vector<std::string>& all) {
    if (const auto faint = resolved(report, "faint_flux_share"))
        all.push_back(fmt::format(
            "{:.0f} % of the light in the weakest channel is carried by photons in which that "
            "channel is below 1/128 of the greatest: they hold it in whole units, at random, so "
            "that its mean is right and its noise larger than that of the other channels",
            100 * *faint));
    if (const auto lobe = resolved(report, "blurred_lobe_degrees"))
        all.push_back(fmt::format(
            "photons hold their directions in steps of 1.4 degrees, and a receiver's lobe falls to "
            "half within {:.2g}: its caustic is blurred, darker by 10 % and more in the lobe's "
            "middle (beamtree and lighttrace keep directions whole)",
            *lobe));
    if (const auto version = resolved(report, "photon_map_version"))
        all.push_back(fmt::format(
            "the photon map's file has version {}: it does not say where the photons' surfaces "
            "face, so that photons of a floor count at the foot of its walls (trace and save it "
            "again)",
            *version));
}

/// Light of one colour that few particles carry, since lights share these by their power. Methods of particles have a
/// number of them.
void note_colours(const Scene& scene, const Method& method, std::vector<std::string>& all) {
    const json parameters = describe(method);
    const auto has = [&](const char* name) { return parameters.contains(name); };
    if (scene.lights().size() < 2 || !(has("photons") || has("emitted") || has("paths"))) return;
    const double share = AimedEmission(scene).least_carried();
    if (share >= least_share_told) return;
    all.push_back(fmt::format(
        "light of one colour is carried by {:.2g} % of the particles, because lights share them by "
        "their power: it is far noisier than the rest, or missing (render weak lights of a colour "
        "of their own apart; pictures add up)",
        100 * share));
}

/// The first dispersive glass that the camera sees, looked for on a grid of the film.
const Shape* dispersive_glass_seen(const Scene& scene) {
    constexpr int columns = 64;
    constexpr int rows = 48;
    const Camera& camera = scene.camera();
    for (int i = 0; i < columns * rows; ++i) {
        const double x = (i % columns + 0.5) / columns * camera.width;
        const double y = (i / columns + 0.5) / rows * camera.height;
        const auto hit = scene.intersect(Ray{camera.position(), camera.direction(x, y)});
        if (hit && is_dispersive(scene.shape_at(*hit).bsdf)) return &scene.shape_at(*hit);
    }
    return nullptr;
}

/// Photons and texels hold colours, not wavelengths: they cannot be asked for the one that glass before the eye
/// picked.
void note_colours_through_glass(const Scene& scene, const Method& method,
                                std::vector<std::string>& all) {
    if (!has_parameter(method, "photons") && !has_parameter(method, "emitted")) return;
    if (!has_dispersive_caster(scene)) return;
    if (const Shape* const glass = dispersive_glass_seen(scene))
        all.push_back(fmt::format(
            "caustics that are seen through {}, which disperses, have wrong colours where light is "
            "spread into colours: {} keeps no wavelengths (beamtree asks for them)",
            glass->name, method.name));
}

// Whether light comes from infinitely far away through a medium that absorbs.
bool comes_through_a_medium(const Scene& scene) {
    return std::ranges::any_of(scene.lights(), [&](const Light& light) {
        const auto point = point_of(light);
        const bool parallel = point && !point->position;
        if (!parallel && !surrounds(light)) return false;
        const Vec3 way = parallel ? point->travel : Vec3(-Vec3::UnitZ());
        const Vec3 outside = scene.bounds().center() - 2 * scene.diameter() * way;
        return !is_clear(scene.medium_around(outside).absorption);
    });
}

/// Whether photons are asked to carry what beams leave out, and there is none of it.
bool has_no_rest(const BuildReport& report) {
    return resolved(report, "flux_share_rest") == 0 && resolved(report, "flux_share_pruned") == 0 &&
           resolved(report, "flux_share_over_budget") == 0;
}

template <class Estimator>
void note_picture(const MethodOf<Estimator>& method, const char* layer, const RunOptions& options,
                  std::vector<std::string>& all) {
    const json given = describe(method);
    if (method.configured->disc_radius() > 0)
        all.push_back(fmt::format(
            "radius={}{} makes no difference in a picture: {} gathers over discs in probe alone",
            given.at("radius").dump(), layer, method.name));
    const SampleCount samples = method.facts().samples;
    if (!samples.of_a_pixel) return;
    const int asked = given.at(samples.parameter).template get<int>();
    const int traced = paths_per_point(asked, options) * options.samples_per_pixel;
    if (traced != asked)
        all.push_back(fmt::format("{} paths a pixel{} are shared by {} samples: {} are traced",
                                  asked, layer, options.samples_per_pixel, traced));
}

}  // namespace

std::vector<std::string> notes_on(const Scene& scene) {
    std::vector<std::string> all;
    for (const BentCaster& caster : bent_casters(scene))
        if (caster.bend > hard_bend)
            all.push_back(fmt::format(
                "smooth normals differ from the triangles of {}: where a mesh has none, they are "
                "averaged over hard edges too, and light that they send to the wrong side of the "
                "surface is lost (face_normals: true shades the triangles flat)",
                caster.text()));
    const Pairs crossing = crossing_dielectrics(scene);
    if (const auto note = what_crosses(scene, crossing)) all.push_back(*note);
    if (const auto note = what_disagrees(scene, crossing)) all.push_back(*note);
    if (const auto faces = what_shares_faces(scene)) all.push_back(*faces);
    for (const LightOnCaster& light : lights_on_casters(scene))
        all.push_back(where_it_lies(scene, light));
    if (eye_medium(scene).ambiguous)
        all.push_back(
            "the dielectrics about the eye disagree on the medium it is in: what it sees directly "
            "is not attenuated (ext_absorption says what is round a dielectric)");
    if (std::ranges::any_of(scene.light_media(), &PlaceMedium::ambiguous))
        all.push_back(
            "the dielectrics about a light disagree on the medium it shines into: its light is not "
            "attenuated before it meets one (ext_absorption says what is round a dielectric)");
    if (comes_through_a_medium(scene))
        all.push_back(
            "light from infinitely far away comes through a medium that absorbs and has no "
            "surface: "
            "it starts at the scene's bounds, and what meets no dielectric is not attenuated (give "
            "the medium a surface, or the light a place)");
    return all;
}

std::vector<std::string> notes(const Scene& scene, const Method& method, const BuildReport& report,
                               const std::optional<CausticLedger>& ledger) {
    std::vector<std::string> all;
    if (ledger) {
        note_misdirected(scene, *ledger, all);
        std::ranges::copy(notes_on_light(method, report, *ledger), std::back_inserter(all));
    }
    note_photons(report, all);
    note_colours(scene, method, all);
    note_colours_through_glass(scene, method, all);
    const std::optional<double> captured = resolved(report, "flux_share_captured");
    if (const auto far = far_caster(scene, captured ? far_for_beams : far_for_photons))
        all.push_back(*far);
    if (!captured) return all;
    if (const auto walls = thin_walls(report)) all.push_back(*walls);
    if (const auto coarse = coarse_glass(scene, method)) all.push_back(*coarse);
    if (const auto pieces = flat_pieces(scene, method)) all.push_back(*pieces);
    if (const auto steps = steps_of_colour(scene, method)) all.push_back(*steps);

    const SetParameters parameters(method);
    const bool disperses = has_dispersive_caster(scene);
    const auto add = [&](const char* name, bool useless, const char* why) {
        if (const auto given = parameters.find(name); given && useless)
            all.push_back(fmt::format("{} makes no difference in this scene: {}", *given, why));
    };
    add("polygons", resolved(report, "quads") == 0, "no caster is divided into a regular grid");
    add("light_samples", !has_area_light(scene), "it has no area light");
    add("mesh_resolution", resolved(report, "casters_tessellated") == 0,
        "every caster is a mesh, which is taken as it is");
    add("wavelengths", !disperses, "no caster is dispersive");
    add("dispersion", !disperses, "no caster is dispersive");
    add("receiver_resolution", !has_exact_receiver(scene),
        "every receiver is a mesh, which is taken as it is");
    add("rest", has_no_rest(report),
        "nothing is left out that rest_photons and rest_nearest could be of");
    return all;
}

std::vector<std::string> notes_on_indirect(const Scene& scene) {
    for (const Shape& shape : scene.shapes()) {
        const auto* const phong = std::get_if<Phong>(&shape.bsdf.model);
        if (phong != nullptr && phong->model == Phong::Model::classic)
            return {fmt::format(
                "{} reflects by Phong's law of 1975, which sends back more than arrives along the "
                "surface: light between walls may grow with every reflection, without end "
                "(model \"normalised\" keeps energy; diffuse_bounces ends paths)",
                shape.name)};
    }
    return {};
}

std::vector<std::string> notes_on_picture(const Method& method,
                                          const std::optional<IndirectMethod>& indirect,
                                          const RunOptions& options) {
    std::vector<std::string> all;
    note_picture(method, "", options, all);
    if (indirect) note_picture(*indirect, " of the indirect layer", options, all);
    return all;
}

}  // namespace caustics::experiments
