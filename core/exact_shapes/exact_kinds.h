#pragma once

#include <array>

#include "core/exact_shapes/cylinder.h"
#include "core/exact_shapes/disk.h"
#include "core/exact_shapes/heightfield.h"
#include "core/exact_shapes/rectangle.h"
#include "core/exact_shapes/sphere.h"

namespace caustics {

/// The exact shapes, each in a fixed local frame, and `mesh`.
enum class Primitive { rectangle, disk, sphere, cylinder, heightfield, mesh };

/// Those with keys of their own in scene files; a heightfield shares its keys with meshes.
inline constexpr std::array exact_primitives{Primitive::rectangle, Primitive::disk,
                                             Primitive::sphere, Primitive::cylinder};

/// Calls `ask` with the kind of an exact shape. A new one is a file of its own, a word in each of the two lists
/// above and a line here.
/// What is asked of a kind, all in its local frame:
/// - `intersect`: its first point along a ray o + t d (d need not be unit); `normal`: unit, of the front side;
/// - `uv`: texture coordinates as Mitsuba's, `round_u`, `round_v` where their ends 0 and 1 are one place;
///   `tangents`: dP/du, dP/dv;
/// - `onto`: the point of the shape beside one near it; `onto_change`: its derivative along a way;
///   `normal_change`: the derivative of `normal` along a way on the shape;
/// - `bounds`; `area` in the world and `sample`, a point uniform by area with its normal, of those that may emit;
/// - `piece`, the hull of those points of a flat one that come from a part of the unit square by `sample`;
///   `hulls` of parts that light is better aimed at one by one;
/// - `tessellate`: its mesh, `least_cells` its least resolution, `is_grid` where those along x and y may differ;
/// - `type`, its name in scene files; `is_flat`; `needs_similarity`: an exact one takes rotations, translations
///   and one scale only;
/// - `povray`: its words there; none: it is written as a mesh;
/// - `text`, its keys there, and `read_placement` where keys place it.
template <class Ask>
decltype(auto) ask_kind(Primitive primitive, const SineHeightfield& field, const Ask& ask) {
    switch (primitive) {
        case Primitive::disk: return ask(Disk{});
        case Primitive::sphere: return ask(Sphere{});
        case Primitive::cylinder: return ask(Cylinder{});
        case Primitive::heightfield: return ask(Heightfield{field});
        default: return ask(Rectangle{});
    }
}

}  // namespace caustics
