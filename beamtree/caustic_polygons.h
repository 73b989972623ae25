#pragma once

#include <memory>

#include "beamtree/beams/beam_params.h"
#include "core/caustic_estimator.h"
#include "core/method/described_method.h"

namespace caustics::beamtree {

/// `causticpolygons` [Watt 1990, as CC95 describes it]: every beam is swept through every diffuse polygon
/// of the polygonised receivers, and those it meets keep it; a point is lit by the caustic polygons
/// that hold it among those of its own diffuse polygon. The same beams, visibility and flux as
/// `beamtree`; cost n_s n_d n_l.
struct CausticPolygonsParams : BeamParams {
    int receiver_resolution = 16;  ///< of exact receivers; meshes are taken as they are
};

const DescribedMethod<CausticPolygonsParams>& causticpolygons_method();

/// Phases "beams" and "polygons". Counters: polygons, receiver_polygons, beams, beam_polygon_tests
/// (one a beam and diffuse polygon), caustic_polygons (pairs that meet), beam_point_tests,
/// beam_point_hits. Throws UnsupportedScene as `beamtree`.
std::unique_ptr<const CausticEstimator> build(const Scene& scene,
                                              const CausticPolygonsParams& params,
                                              const RunOptions& options);

}  // namespace caustics::beamtree
