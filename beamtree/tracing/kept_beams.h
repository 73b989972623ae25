#pragma once

#include <cstdint>
#include <vector>

#include "beamtree/beams/beam.h"
#include "beamtree/tracing/scene_boxes.h"
#include "beamtree/tracing/trace_settings.h"

namespace caustics::beamtree {

// Which of a set's beams are kept for queries: `kept` has one a beam.

/// Leaves out those that can meet no receiver, and returns how many they are.
std::uint64_t leave_out_unreceived(std::vector<bool>& kept, const BeamSet& set,
                                   const SceneBoxes& boxes, const TraceSettings& settings);
/// Takes the others out of the set. Their rays stay: all of them choose the set's test planes.
void keep_only(BeamSet& set, const std::vector<bool>& kept);

}  // namespace caustics::beamtree
