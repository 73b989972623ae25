#include "core/scene_file/values.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/atomic_file.h"
#include "core/base/lower_case.h"
#include "core/base/near_words.h"
#include "core/math/coordinate_limit.h"

namespace caustics::scene_file {
namespace {

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

Spectrum read_three(const JsonNode& node, double most) {
    Spectrum value;
    if (node.is_number()) {
        value = Spectrum::Constant(static_cast<float>(node.as_number_in(0, most)));
    } else {
        if (!node.is_array() || node.as_array().size() != 3)
            node.fail("must be a number, [r, g, b] or {\"type\": \"rgb\", \"value\": ...}, got " +
                      node.words());
        const std::vector<JsonNode> parts = node.as_array();
        for (Eigen::Index c = 0; c < 3; ++c)
            value[c] = static_cast<float>(parts[static_cast<std::size_t>(c)].as_number_in(0, most));
    }
    return value;
}

// +z from origin to target, +y up, +x to the left (Mitsuba's look_at).
Transform read_look_at(const JsonNode& node) {
    const Vec3d origin = read_vector(node.at("origin"));
    const Vec3d forward = read_vector(node.at("target")) - origin;
    const Vec3d up = read_vector(node.at("up"));
    node.finish();
    const Vec3d left = up.cross(forward);
    if (left.norm() <= 1e-12 * up.norm() * forward.norm())
        node.fail("look_at needs a target away from the origin and an up not along the view");
    Transform result = Transform::Identity();
    result.linear().col(0) = left.normalized();
    result.linear().col(1) = forward.cross(left).normalized();
    result.linear().col(2) = forward.normalized();
    result.translation() = origin;
    return result;
}

Transform read_rotation(const JsonNode& node) {
    const Vec3d axis = read_vector(node.at("axis"));
    const double degrees = node.at("angle").as_number_in(-most_turned, most_turned);
    node.finish();
    if (axis.norm() == 0) node.at("axis").fail("must not be zero");
    return Transform(Eigen::AngleAxisd(degrees * pi_d / 180, axis.normalized()));
}

Transform read_operation(const JsonNode& node) {
    const auto translate = node.find("translate");
    const auto rotate = node.find("rotate");
    const auto scale = node.find("scale");
    const auto look_at = node.find("look_at");
    node.finish();
    if (int{translate.has_value()} + int{rotate.has_value()} + int{scale.has_value()} +
            int{look_at.has_value()} !=
        1)
        node.fail("must be one operation of translate, rotate, scale, look_at");
    if (translate) return Transform(Eigen::Translation3d(read_vector(*translate)));
    if (rotate) return read_rotation(*rotate);
    if (look_at) return read_look_at(*look_at);
    const Vec3d factors = scale->is_number()
                              ? Vec3d(Vec3d::Constant(scale->as_number_in(-unlimited, unlimited)))
                              : read_vector(*scale);
    return Transform(Eigen::Scaling(factors));
}

Transform read_matrix(const JsonNode& node, const std::vector<JsonNode>& entries) {
    std::vector<double> values;
    for (const JsonNode& entry : entries) {
        if (entry.is_number())
            values.push_back(entry.as_number());
        else
            for (const double value : entry.as_numbers(4)) values.push_back(value);
    }
    if (values.size() != 16)
        node.fail("must be a 4x4 matrix (16 numbers or 4 rows of 4) or a list of operations");
    Transform result;
    for (Eigen::Index row = 0; row < 4; ++row)
        for (Eigen::Index column = 0; column < 4; ++column)
            result.matrix()(row, column) = values[static_cast<std::size_t>(4 * row + column)];
    if (result.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1))
        node.fail("the last row of the matrix must be 0 0 0 1");
    return result;
}

}  // namespace

Vec2d read_pair(const JsonNode& node) {
    const std::vector<double> values = node.as_numbers(2);
    const Vec2d pair(values[0], values[1]);
    if (pair.cwiseAbs().maxCoeff() > unlimited) node.fail("is out of range (to 1e+30)");
    return pair;
}

Vec3d read_vector(const JsonNode& node) {
    const std::vector<double> values = node.as_numbers(3);
    if (std::ranges::any_of(values, [](double value) { return std::abs(value) > unlimited; }))
        for (const JsonNode& component : node.as_array())
            component.as_number_in(-unlimited, unlimited);
    return {values[0], values[1], values[2]};
}

void require_near(const JsonNode& node, const std::vector<Vec3d>& points) {
    for (const Vec3d& point : points)
        if (!within_limit(point))
            node.fail(fmt::format("reaches beyond {:g} m from the origin", farthest_coordinate));
}

Spectrum read_colour(const JsonNode& node, double most) {
    if (!node.is_object()) return read_three(node, most);
    read_type(node, "colour", {"rgb"}, {"spectrum", "uniform", "d65", "blackbody"});
    const Spectrum value = read_three(node.at("value"), most);
    node.finish();
    return value;
}

Spectrum read_colour(const JsonNode& parent, const std::string& key, double fallback, double most) {
    const auto node = parent.find(key);
    return node ? read_colour(*node, most)
                : Spectrum(Spectrum::Constant(static_cast<float>(fallback)));
}

Transform read_transform(const JsonNode& node) {
    const std::vector<JsonNode> entries = node.as_array();
    Transform result = Transform::Identity();
    if (!entries.empty() && !entries.front().is_object()) {
        result = read_matrix(node, entries);
    } else {
        for (const JsonNode& entry : entries) result = read_operation(entry) * result;
    }
    const Eigen::Matrix3d linear = result.linear();
    const double size = linear.cwiseAbs().maxCoeff();
    if (!(result.matrix().cwiseAbs().maxCoeff() <= unlimited))
        node.fail("the transform's numbers reach beyond 1e30");
    if (!(std::abs(linear.determinant()) > 1e-12 * size * size * size))
        node.fail("the transform is singular: it flattens or deletes what it is applied to");
    return result;
}

std::filesystem::path read_file_name(const JsonNode& node, Assets& assets) {
    const std::string name = node.as_string();
    const std::filesystem::path file = node.file().parent_path() / name;
    load_for(node, [&] { require_regular_file(file); });
    const std::pair<std::filesystem::path, std::string> asset{file, name};
    if (assets.noted.insert(asset).second) assets.files.push_back(asset);
    return file;
}

std::string read_type(const JsonNode& node, const std::string& family,
                      const std::vector<std::string>& known,
                      const std::vector<std::string>& later) {
    const std::string type = node.at("type").as_string();
    if (const auto found = find_word(known, type); found != known.end()) return *found;
    const bool planned = find_word(later, type) != later.end();
    node.fail(family + " type \"" + type + "\" is " +
              (planned ? "not supported (yet)" : "unknown" + did_you_mean(type, known)) +
              " (known: " + joined(known) + ")");
}

}  // namespace caustics::scene_file
