#pragma once

#include <functional>

#include "tests/cruel/parts.h"

namespace caustics::cruel {

/// A scene that is as small as can be found and still fails: members and elements are left out, numbers
/// rounded, one after another while `fails` says so. It must answer no for what is no valid scene.
Json shrunk(Json scene, const std::function<bool(const Json&)>& fails);

}  // namespace caustics::cruel
