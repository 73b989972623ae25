#include "tests/cruel/shrink.h"

#include <cmath>
#include <string>
#include <vector>

namespace caustics::cruel {

namespace {

using Pointer = Json::json_pointer;

// Children before their parents' later siblings; a parent before its children.
void collect(const Json& value, const Pointer& here, std::vector<Pointer>& all) {
    if (!here.empty()) all.push_back(here);
    if (value.is_object())
        for (const auto& [key, child] : value.items()) collect(child, here / key, all);
    if (value.is_array())
        for (std::size_t i = 0; i < value.size(); ++i) collect(value[i], here / i, all);
}

void erase(Json& scene, const Pointer& what) {
    Json& parent = scene.at(what.parent_pointer());
    if (parent.is_object()) parent.erase(what.back());
    if (parent.is_array()) parent.erase(std::stoul(what.back()));
}

std::vector<Json> simpler(const Json& value) {
    if (!value.is_number()) return {};
    const auto x = value.get<double>();
    std::vector<Json> all;
    for (const double digits : {1.0, 10.0, 100.0}) {
        const double rounded = std::round(x * digits) / digits;
        if (rounded == x) break;
        all.emplace_back(value.is_number_integer() ? Json(std::lround(rounded)) : Json(rounded));
    }
    return all;
}

// One pass over all there is; whether anything became simpler.
bool shrink_once(Json& scene, const std::function<bool(const Json&)>& fails) {
    bool changed = false;
    std::vector<Pointer> all;
    collect(scene, Pointer(), all);
    const auto take = [&](Json&& candidate) {
        if (!fails(candidate)) return false;
        scene = std::move(candidate);
        return changed = true;
    };
    // From the back, so that what is left keeps its pointer.
    for (auto at = all.rbegin(); at != all.rend(); ++at) {
        if (!scene.contains(*at)) continue;
        Json without = scene;
        erase(without, *at);
        if (take(std::move(without))) continue;
        for (const Json& value : simpler(scene.at(*at))) {
            Json rounded = scene;
            rounded.at(*at) = value;
            if (take(std::move(rounded))) break;
        }
    }
    return changed;
}

}  // namespace

Json shrunk(Json scene, const std::function<bool(const Json&)>& fails) {
    for (int pass = 0; pass < 4 && shrink_once(scene, fails); ++pass) {}
    return scene;
}

}  // namespace caustics::cruel
