#pragma once

#include <vector>

#include "beamtree/beams/beam_params.h"
#include "core/method/parameter.h"

namespace caustics::beamtree {

/// The rows of BeamParams in a method's table.
template <class Params>
std::vector<Parameter<Params>> beam_param_table() {
    return {
        parameter::choice<Params>(
            &BeamParams::polygons,
            {{"triangles", PolygonKind::triangle}, {"quads", PolygonKind::quad}},
            {.key = "polygons",
             .meaning = "What casters are divided into; quads only where they have a grid.",
             .source = "[CC95 sec. 3.1]"}),
        parameter::whole_number<Params>(&BeamParams::light_samples, 1, 65'536,
                                        {.key = "light_samples",
                                         .meaning = "Points that stand for each area light.",
                                         .unit = "points"}),
        parameter::whole_number<Params>(
            &BeamParams::mesh_resolution, 2, 4096,
            {.key = "mesh_resolution",
             .meaning =
                 "Polygons along each parameter of exact casters; meshes are taken as they are.",
             .unit = "polygons"}),
        parameter::max_bounces<Params>(),
        parameter::number<Params>(
            &BeamParams::prune, 0, 1,
            {.key = "prune",
             .meaning = "Beams with less than this of the light of the first events' beams on "
                        "average are not followed."})
            .only_if([](const Params& params) { return params.prune != BeamParams{}.prune; }),
        parameter::whole_number<Params>(
            &BeamParams::max_beams, 1, 1'000'000'000,
            {.key = "max_beams",
             .meaning =
                 "Most beams of several events, those with the most light (a division of a polygon "
                 "counts as one); each takes about half a kilobyte while they are traced.",
             .unit = "beams"})
            .only_if(
                [](const Params& params) { return params.max_beams != BeamParams{}.max_beams; }),
        parameter::whole_number<Params>(
            &BeamParams::wavelengths, 1, 4096,
            {.key = "wavelengths",
             .meaning =
                 "Parts of equal power that each light is divided into, by wavelength, where a "
                 "caster is dispersive.",
             .unit = "wavelengths",
             .source = "[C11]"})
            .only_if([](const Params& params) {
                return params.wavelengths != BeamParams{}.wavelengths;
            })};
}

}  // namespace caustics::beamtree
