#pragma once

namespace caustics {

/// A particle counts for a receiver point only where it landed on a surface that faces much as the
/// point's does: so much of a cosine, at least, between the two geometric normals. Otherwise a disc
/// in the corner of a room would see round it. At 60 degrees a sphere loses nothing to a disc up to
/// its own radius, and walls that meet at less than 120 degrees stay apart. Plain, for the loops of
/// every instruction set.
constexpr float same_surface_cosine = 0.5F;

}  // namespace caustics
