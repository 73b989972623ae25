#pragma once

#include <type_traits>
#include <variant>

namespace caustics {

/// Calls `visit` with std::type_identity of each type that a variant may hold, in their order.
template <class... Kinds, class Visit>
void each_kind(std::type_identity<std::variant<Kinds...>>, const Visit& visit) {
    (visit(std::type_identity<Kinds>()), ...);
}

}  // namespace caustics
