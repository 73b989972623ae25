#include <fmt/format.h>

#include <fstream>

#include "core/geometry/tessellate.h"
#include "core/render/film.h"
#include "tests/cruel/parts.h"

namespace caustics::cruel {

std::filesystem::path Parts::new_file(const std::string& extension) {
    return folder_ / fmt::format("part{}{}", files_++, extension);
}

Json Parts::turn() {
    return Json::object(
        {{"rotate",
          {{"axis", {dice_.number(-1, 1), dice_.number(-1, 1), dice_.number(0.1, 1)}},
           {"angle", dice_.number(-180, 180)}}}});
}

// A mesh that stands for everybody is flat where light is measured: between the corners of a smooth
// one beams bend light on a straight-line mean.
Json Parts::exact_or_mesh(Json shape, int least, int most) {
    if (dice_.chance(0.3)) {
        shape["resolution"] = dice_.whole(least, most);
        if (measured() || dice_.chance(0.5)) shape["face_normals"] = true;
    }
    return shape;
}

namespace {

std::string ply_text(const TriangleMesh& mesh) {
    std::string text = fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty "
        "float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions.size(), mesh.triangles.size());
    for (const Vec3& p : mesh.positions) text += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
    for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
    return text;
}

std::string obj_text(const TriangleMesh& mesh) {
    std::string text;
    for (const Vec3& p : mesh.positions) text += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
    for (const auto& [a, b, c] : mesh.triangles)
        text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
    return text;
}

// Doubled triangles, some with another first corner, triangles without area, holes, and vertices that
// nothing uses.
void spoil(TriangleMesh& mesh, Dice& dice, bool closed) {
    const auto any = [&] {
        return mesh.triangles[static_cast<std::size_t>(
            dice.whole(0, static_cast<int>(mesh.triangles.size()) - 1))];
    };
    if (dice.chance(0.3)) {
        const auto t = any();
        mesh.triangles.push_back(dice.chance(0.5) ? t : decltype(t){t[1], t[2], t[0]});
    }
    if (dice.chance(0.3)) {
        const auto t = any();
        mesh.triangles.push_back({t[0], t[0], t[1]});
    }
    if (dice.chance(0.2)) mesh.positions.emplace_back(Vec3::Constant(1e5F));
    if (!closed && dice.chance(0.5))
        mesh.triangles.erase(mesh.triangles.begin() +
                             dice.whole(0, static_cast<int>(mesh.triangles.size()) - 1));
}

}  // namespace

Json Parts::mesh_file(bool closed) {
    TriangleMesh mesh = tessellate_sphere(dice_.whole(4, 8));
    spoil(mesh, dice_, closed);
    const bool orient = dice_.chance(0.3);
    if (orient)
        for (auto& t : mesh.triangles)
            if (dice_.chance(0.3)) std::swap(t[1], t[2]);
    const std::string type = dice_.pick({"ply", "obj"});
    const auto file = new_file("." + type);
    std::ofstream(file) << (type == "ply" ? ply_text(mesh) : obj_text(mesh));
    Json shape = {{"type", type}, {"filename", file.filename().string()}};
    if (orient) shape["orient"] = true;
    if (measured() || dice_.chance(0.5)) shape["face_normals"] = true;
    return shape;
}

Json Parts::lathe(bool closed) {
    Json shape = {{"type", "lathe"},
                  {"resolution", dice_.whole(measured() ? 6 : 3, dice_.chance(0.2) ? 32 : 12)}};
    const double bulge = dice_.number(0.3, 0.8);
    Json profile = {{closed ? 0.0 : 0.2, -0.8}, {bulge, dice_.number(-0.5, 0)}, {0.3, 0.6}};
    if (dice_.chance(0.5)) profile[1] = {{"at", profile[1]}, {"crease", dice_.chance(0.5)}};
    if (closed)
        profile.push_back({0, 0.8});
    else
        shape["open"] = true;
    shape["profile"] = profile;
    if (dice_.chance(0.5)) shape["interpolation"] = dice_.pick({"linear", "catmullrom"});
    if (dice_.chance(0.9)) shape["segments"] = dice_.whole(1, dice_.chance(0.2) ? 6 : 2);
    if (measured() || dice_.chance(0.5)) shape["face_normals"] = true;
    return shape;
}

/// A straight profile that meets the axis aslant, at a crease or not.
Json Parts::cone(bool closed) {
    const double radius = dice_.number(0.3, 0.8), bottom = dice_.number(-0.4, 0.2);
    const Json apex = {0.0, 0.6};
    Json profile = {apex, {{"at", {radius, bottom}}, {"crease", true}}};
    if (dice_.chance(0.5)) profile[0] = {{"at", apex}, {"crease", true}};
    if (closed) profile.push_back({0.0, bottom});
    Json shape = {{"type", "lathe"},
                  {"profile", profile},
                  {"interpolation", "linear"},
                  {"resolution", dice_.whole(24, 64)},
                  {"segments", dice_.whole(4, 16)}};
    if (!closed) shape["open"] = true;
    return shape;
}

/// A curved profile without creases, with interpolated normals.
Json Parts::smooth_lathe(bool closed) {
    const double bulge = dice_.number(0.3, 0.7);
    const Json profile = {
        {closed ? 0.0 : 0.2, -0.6}, {bulge, dice_.number(-0.3, 0.3)}, {closed ? 0.0 : 0.3, 0.6}};
    Json shape = {{"type", "lathe"},
                  {"profile", profile},
                  {"interpolation", "catmullrom"},
                  {"resolution", dice_.whole(24, 64)},
                  {"segments", dice_.whole(8, 16)}};
    if (!closed) shape["open"] = true;
    return shape;
}

Json Parts::cut() {
    Json rings = Json::array();
    for (const double angle : {-40.0, 0.0, 35.0}) {
        rings.push_back({{"count", dice_.whole(3, 9)},
                         {"angle", angle + dice_.number(-5, 5)},
                         {"distance", dice_.number(0.4, 0.6)}});
        if (dice_.chance(0.5)) rings.back()["phase"] = dice_.number(0, 1);
    }
    Json shape = {{"type", "cut"}, {"rings", rings}};
    if (dice_.chance(0.5))
        shape["planes"] = Json::array({{dice_.number(-1, 1), 0.3, -1, dice_.number(0.3, 0.5)}});
    if (dice_.chance(0.6)) shape["height"] = 0.4;
    if (shape.contains("height") && dice_.chance(0.5)) {
        shape["inner"] = {{"profile", {{0.15, 0.4}, {0.12, 0.2}, {0, 0.1}}}};
        if (dice_.chance(0.5)) shape["inner"]["interpolation"] = "catmullrom";
        if (dice_.chance(0.5)) shape["inner"]["segments"] = dice_.whole(1, 4);
        shape["resolution"] = dice_.whole(3, 16);
        shape["face_normals"] = true;
    }
    return shape;
}

Json Parts::solid() {
    if (measured() && dice_.chance(0.2)) return dice_.chance(0.5) ? cone(true) : smooth_lathe(true);
    switch (dice_.whole(0, 7)) {
        case 0: return cut();
        case 1: return lathe(true);
        case 2: return mesh_file(true);
        case 3: {
            Json cube = {{"type", "cube"}};
            cube["to_world"] = Json::array({scale_by(0.57)});
            if (measured() || dice_.chance(0.5)) cube["resolution"] = dice_.whole(1, 12);
            return cube;
        }
        default: {
            Json ball = {{"type", "sphere"}};
            if (dice_.chance(0.2)) ball["center"] = {0, dice_.number(-0.2, 0.2), 0};
            if (ball.contains("center")) ball["radius"] = dice_.number(0.3, 0.8);
            return exact_or_mesh(ball, measured() ? 6 : 2, 10);
        }
    }
}

Json Parts::waves() {
    Json list = Json::array();
    for (int i = dice_.whole(1, 3); i > 0; --i) {
        list.push_back({{"amplitude", dice_.number(-0.05, 0.05)},
                        {"wave_vector", {dice_.number(-6, 6), dice_.number(-6, 6)}}});
        if (dice_.chance(0.5)) list.back()["phase"] = dice_.number(-3, 3);
    }
    Json shape = {{"type", "heightfield"}, {"waves", list}};
    if (dice_.chance(0.5)) shape["half_size"] = {dice_.number(0.3, 0.7), dice_.number(0.3, 0.7)};
    return exact_or_mesh(shape, 4, 12);
}

Json Parts::ground() {
    Json shape = {{"type", "heightfield"}};
    if (dice_.chance(0.5)) {
        shape["fractal"] = {{"levels", dice_.whole(2, 4)}, {"rms", dice_.number(0, 0.1)}};
        if (dice_.chance(0.5)) shape["fractal"]["hurst"] = dice_.number(0, 1);
        if (dice_.chance(0.5)) shape["fractal"]["lowest"] = dice_.whole(1, 2);
        if (dice_.chance(0.5)) shape["fractal"]["seed"] = dice_.whole(0, 9999);
    } else {
        const int width = dice_.whole(2, 6);
        Film heights(width, dice_.whole(2, 6));
        for (float& z : heights.plane("Y")) z = static_cast<float>(dice_.number(0, 0.2));
        const auto file = new_file(".exr");
        write_exr(heights, file);
        shape["filename"] = file.filename().string();
        if (dice_.chance(0.5)) shape["height"] = dice_.number(-1, 1);
    }
    shape["half_size"] = {0.6, 0.6};
    if (measured() || dice_.chance(0.5)) shape["face_normals"] = true;
    return shape;
}

Json Parts::sheet() {
    if (measured() && dice_.chance(0.2))
        return dice_.chance(0.5) ? cone(false) : smooth_lathe(false);
    switch (dice_.whole(0, 7)) {
        case 0: return waves();
        case 1: return ground();
        case 2: return mesh_file(false);
        case 3: return lathe(false);
        case 4:
            return exact_or_mesh({{"type", "cylinder"},
                                  {"p0", {0, 0, dice_.number(-0.5, 0)}},
                                  {"p1", {0, dice_.number(0, 0.3), 0.5}},
                                  {"radius", dice_.number(0.2, 0.6)}},
                                 measured() ? 8 : 3, 12);
        case 5: return exact_or_mesh({{"type", "disk"}}, measured() ? 8 : 1, 16);
        default: {
            Json shape = exact_or_mesh({{"type", "rectangle"}}, 1, 8);
            if (shape.contains("resolution") && dice_.chance(0.5))
                shape["resolution"] = {dice_.whole(1, 8), dice_.whole(1, 8)};
            shape["to_world"] = Json::array({scale_by(0.7)});
            return shape;
        }
    }
}

}  // namespace caustics::cruel
