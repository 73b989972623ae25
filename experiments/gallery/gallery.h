#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace caustics::experiments {

/// A place of a receiver where the light of a layer is known.
struct KnownPoint {
    Vec3d position;
    Vec3d normal;              ///< unit, on the lit side
    Vec3d wo = Vec3d::Zero();  ///< where a viewer looks from; zero: the irradiance is asked
    double truth = 0;          ///< [W/m^2], or with a viewer [W m^-2 sr^-1], mean of the channels
};

/// How much work a method is given at one step of a series.
struct Effort {
    int resolution = 0;                   ///< of the scene's own meshes
    std::vector<std::string> parameters;  ///< of the method, k=v
};

/// One method at growing effort. From step to step its error should fall by `factor`: by 2, say,
/// for twice the mesh resolution at first order, or for four times the particles.
struct Series {
    std::string method;
    std::vector<Effort> efforts;
    double factor = 2;
    double tolerance = 0.05;  ///< of the last step's error
    double radius = 0;        ///< of the discs of methods that gather over them [m]
    std::string variant;      ///< a parameter that the table names, beside the method
    bool indirect = false;    ///< a method of the layer `indirect`
};

/// A scene whose caustic, or indirect light, is a formula, or a quadrature good to 1e-6.
struct GalleryScene {
    std::string name;
    std::string answer;  ///< in a few words
    /// The scene; shapes that are no exact ones are meshes of that resolution.
    std::function<SceneDesc(int resolution)> make;
    std::vector<KnownPoint> points;
    std::vector<Series> series;
};

/// All of them; each derivation stands where its scene is made.
std::vector<GalleryScene> gallery();

/// The parts of it.
std::vector<GalleryScene> mirrors();
std::vector<GalleryScene> lenses();
std::vector<GalleryScene> laws();
std::vector<GalleryScene> rooms();

/// Still water that absorbs `sigma` [1/m], on a floor under a point light.
GalleryScene still_water(const std::string& name, const std::string& answer, double sigma);

}  // namespace caustics::experiments
