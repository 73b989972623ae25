#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/run/caustic_ledger.h"
#include "experiments/run/method.h"

namespace caustics::experiments {

/// What a user should know of a scene, one line each and mostly none: casters whose smooth normals
/// differ much from their triangles, and an eye whose medium is not known.
std::vector<std::string> notes_on(const Scene& scene);

/// What a user should know of a picture that could be made, beside that of its scene: a caster so far
/// from the others that floats are too coarse for it, how much of the caustic is lost (from 1 % on) at
/// `max_bounces`, by beams that are not followed and by smooth normals, photons with channels that
/// differ much, caustics seen through dispersive glass by a method without wavelengths, an old photon
/// map's file, and parameters that were set and make no difference.
std::vector<std::string> notes(const Scene& scene, const Method& method, const BuildReport& report,
                               const std::optional<CausticLedger>& ledger);

/// What is to be known where light between walls is asked for: a law by which it may grow without end.
std::vector<std::string> notes_on_indirect(const Scene& scene);

/// What is to be known of parameters where a picture is made, beside notes(): those that only points of `probe` take,
/// and paths a pixel that its samples do not share evenly. `options` are those of the picture.
std::vector<std::string> notes_on_picture(const Method& method,
                                          const std::optional<IndirectMethod>& indirect,
                                          const RunOptions& options);

}  // namespace caustics::experiments
