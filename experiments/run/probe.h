#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/caustic_estimator.h"
#include "experiments/base/csv.h"
#include "experiments/run/method.h"

namespace caustics::experiments {

/// A row of a point list.
struct ProbePoint {
    Vec3d position;  ///< in the world
    Vec3 normal;     ///< unit; names the side of the receiver
    Vec3 wo;         ///< unit, towards the viewer; the normal when the list has no viewer
    float radius = 0;
};

/// A list of points as the CSV file gives them, with the text of its rows.
struct ProbeList {
    std::filesystem::path file;
    NumberTable table;
    std::vector<ProbePoint> points;
    bool has_viewer = false;
};

/// Reads x,y,z,nx,ny,nz and optionally wx,wy,wz and radius; directions are normalised. Throws
/// InputError naming the row for a zero direction, a viewer below the normal, or a negative radius.
ProbeList read_probe_list(const std::filesystem::path& file);

/// Answers of a method, one a point.
struct ProbeAnswers {
    std::vector<Estimate> irradiance;
    std::vector<Estimate> radiance;  ///< empty without viewers
    bool has_standard_errors = false;
    std::vector<std::string> notes;  ///< as RunResult::notes
};

/// Builds the method, of the caustic or of the indirect layer, and asks it at the points. A point on a black side (the back of a one-sided
/// material) answers black. Throws InputError naming the row of a point that is farther than 1e-4
/// of the scene's diameter from every receiver, or that lacks a radius the method needs.
ProbeAnswers probe(const Scene& scene, const Method& method, const ProbeList& list,
                   const RunOptions& options);
ProbeAnswers probe(const Scene& scene, const IndirectMethod& method, const ProbeList& list,
                   const RunOptions& options);

/// The rows as they were, with the answers beside them.
std::string probe_table(const ProbeList& list, const ProbeAnswers& answers);

}  // namespace caustics::experiments
