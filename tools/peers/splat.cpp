// Plain forward splatting, the ideal rival: stratified light paths aimed at one caster of known shape, followed without an
// intersector, each end added to the pixel that sees it. It shares no code with the project.
//
// Usage: splat SHAPE SAMPLES SEED FILE < NUMBERS
// SHAPE is pool, ring or ball. NUMBERS: width, height, tangent of half the horizontal field of view; the camera's origin, right,
// up and forward (unit vectors); the lamp's position; the floor's height, half size and reflectance; then the shape's own (below).
// FILE gets height x width floats: mean radiance of each pixel [W/m2/sr] for a lamp of 1 W/sr. Lengths in metres.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <numbers>
#include <vector>

namespace {

constexpr double pi = std::numbers::pi;
constexpr int most_events = 16;

struct Vector {
    double x, y, z;
};
Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector operator*(double s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector unit(Vector a) { return (1 / std::sqrt(dot(a, a))) * a; }

double number() {
    double value;
    if (!(std::cin >> value)) {
        std::fprintf(stderr, "splat: too few numbers\n");
        std::exit(2);
    }
    return value;
}
Vector vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
}

// SplitMix64 [Steele et al. 2014], uniform in [0, 1).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 1) {}
    double next() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }

private:
    std::uint64_t state_;
};

class Film {
public:
    Film()
        : width_(static_cast<int>(number())),
          height_(static_cast<int>(number())),
          tangent_(number()),
          eye_(vector()),
          right_(vector()),
          up_(vector()),
          forward_(vector()),
          lamp(vector()),
          floor_(number()),
          half_size_(number()),
          reflectance_(number()),
          pixels_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

    // Flux [W for 1 W/sr] on the floor at the end of a ray that goes down.
    void add(Vector from, Vector along, double flux) {
        const Vector at = from + ((floor_ - from.z) / along.z) * along;
        if (std::max(std::abs(at.x), std::abs(at.y)) > half_size_) {
            return;
        }
        const Vector seen = at - eye_;
        const double depth = dot(seen, forward_), scale = 0.5 * width_ / (depth * tangent_);
        const double column = 0.5 * width_ + dot(seen, right_) * scale,
                     row = 0.5 * height_ - dot(seen, up_) * scale;
        if (depth <= 0 || column < 0 || row < 0 || column >= width_ || row >= height_) {
            return;
        }
        // Pixels of the film for each square metre of the floor.
        const double density =
            std::abs(seen.z) / (depth * depth * depth) * std::pow(0.5 * width_ / tangent_, 2);
        pixels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                static_cast<std::size_t>(column)] += flux * density;
    }
    bool write(const char* path) const {
        std::vector<float> radiance;
        for (const double each : pixels_) {
            radiance.push_back(static_cast<float>(each * reflectance_ / pi));
        }
        std::FILE* file = std::fopen(path, "wb");
        return file &&
               std::fwrite(radiance.data(), sizeof(float), radiance.size(), file) ==
                   radiance.size() &&
               std::fclose(file) == 0;
    }

private:
    int width_, height_;
    double tangent_;
    Vector eye_, right_, up_, forward_;

public:
    Vector lamp;

private:
    double floor_, half_size_, reflectance_;
    std::vector<double> pixels_;
};

struct Refracted {
    Vector along;
    double transmittance;
};
// Snell's law and Fresnel's for unpolarised light; the normal is a unit vector against the ray, ior of the far side over the near.
Refracted refract(Vector into, Vector normal, double ior) {
    const double outer = -dot(into, normal), square = 1 - (1 - outer * outer) / (ior * ior);
    if (square <= 0) {
        return {into, 0};
    }
    const double inner = std::sqrt(square);
    const double across = (outer - ior * inner) / (outer + ior * inner),
                 along = (inner - ior * outer) / (inner + ior * outer);
    return {(1 / ior) * into + (outer / ior - inner) * normal,
            1 - (across * across + along * along) / 2};
}
Vector reflect(Vector into, Vector normal) { return into - 2 * dot(into, normal) * normal; }

// Numbers: ior, half sizes along x and y, count of waves, then amplitude, wave vector and phase of each.
class Pool {
public:
    Pool()
        : ior_(number()),
          half_x_(number()),
          half_y_(number()),
          waves_(static_cast<std::size_t>(number())) {
        for (Wave& wave : waves_) {
            wave = {number(), number(), number(), number()};
        }
    }
    void splat(Film& film, double u, double v, double share) const {
        const double x = half_x_ * (2 * u - 1), y = half_y_ * (2 * v - 1);
        double height = 0, slope_x = 0, slope_y = 0;
        for (const Wave& wave : waves_) {
            const double angle = wave.x * x + wave.y * y + wave.phase,
                         slope = wave.amplitude * std::cos(angle);
            height += wave.amplitude * std::sin(angle);
            slope_x += wave.x * slope;
            slope_y += wave.y * slope;
        }
        const Vector at{x, y, height}, away = at - film.lamp, steep{-slope_x, -slope_y, 1};
        const double distance = std::sqrt(dot(away, away)),
                     flux =
                         -dot(away, steep) / std::pow(distance, 3) * 4 * half_x_ * half_y_ * share;
        const Refracted down = refract((1 / distance) * away, unit(steep), ior_);
        film.add(at, down.along, flux * down.transmittance);
    }

private:
    struct Wave {
        double amplitude, x, y, phase;
    };
    double ior_, half_x_, half_y_;
    std::vector<Wave> waves_;
};

// A cylinder round the z axis that mirrors, the lamp inside its radius and above it. Numbers: radius, bottom, top, reflectance.
class Ring {
public:
    Ring() : radius_(number()), bottom_(number()), top_(number()), reflectance_(number()) {}
    void splat(Film& film, double u, double v, double share) const {
        const Vector flat{std::cos(2 * pi * u), std::sin(2 * pi * u), 0};
        const double run = reach(film.lamp, flat);
        const auto rise = [&](double z) {
            return (z - film.lamp.z) / std::hypot(z - film.lamp.z, run);
        };
        const double low = rise(bottom_), high = rise(top_), sine = low + v * (high - low);
        const Vector along = std::sqrt(1 - sine * sine) * flat + Vector{0, 0, sine};
        follow(film, film.lamp, along, 2 * pi * (high - low) * share);
    }

private:
    // Distance to the wall from inside of it, along a ray's run over the ground.
    double reach(Vector from, Vector along) const {
        const double a = along.x * along.x + along.y * along.y,
                     b = from.x * along.x + from.y * along.y;
        return (std::sqrt(b * b - a * (from.x * from.x + from.y * from.y - radius_ * radius_)) -
                b) /
               a;
    }
    void follow(Film& film, Vector from, Vector along, double flux) const {
        for (int event = 0; event < most_events; ++event) {
            const Vector at = from + reach(from, along) * along;
            if (at.z < bottom_) {
                break;
            }
            along = reflect(along, unit({-at.x, -at.y, 0}));
            from = at;
            flux *= reflectance_;
        }
        film.add(from, along, flux);
    }
    double radius_, bottom_, top_, reflectance_;
};

// Numbers: centre, radius, ior.
class Ball {
public:
    Ball() : centre_(vector()), radius_(number()), ior_(number()) {}
    void splat(Film& film, double u, double v, double share) const {
        const Vector to = centre_ - film.lamp, axis = unit(to);
        const double edge = std::sqrt(1 - radius_ * radius_ / dot(to, to)),
                     cosine = 1 - v * (1 - edge), sine = std::sqrt(1 - cosine * cosine);
        const Vector side =
            unit(std::abs(axis.x) < 0.5 ? Vector{0, axis.z, -axis.y} : Vector{axis.z, 0, -axis.x});
        const Vector other{axis.y * side.z - axis.z * side.y, axis.z * side.x - axis.x * side.z,
                           axis.x * side.y - axis.y * side.x};
        const Vector along =
            cosine * axis + sine * (std::cos(2 * pi * u) * side + std::sin(2 * pi * u) * other);
        const double middle = dot(to, along),
                     reach = middle - std::sqrt(std::max(
                                          0.0, middle * middle - dot(to, to) + radius_ * radius_));
        follow(film, film.lamp + reach * along, along, 2 * pi * (1 - edge) * share);
    }

private:
    void leave(Film& film, Vector from, Vector along, double flux) const {
        if (along.z < 0) {
            film.add(from, along, flux);
        }
    }
    // Both ways at each event: the angle inside is always the same, and so is what is let through.
    void follow(Film& film, Vector at, Vector along, double flux) const {
        Vector normal = (1 / radius_) * (at - centre_);
        const Refracted entered = refract(along, normal, ior_);
        const double through = entered.transmittance;
        leave(film, at, reflect(along, normal), flux * (1 - through));
        Vector inside = entered.along;
        double left = flux * through;
        for (int event = 1; event < most_events && left > 1e-6 * flux; ++event) {
            at = at - 2 * radius_ * dot(inside, normal) * inside;
            normal = (1 / radius_) * (at - centre_);
            const Vector inward = -1.0 * normal;
            leave(film, at, refract(inside, inward, 1 / ior_).along, left * through);
            inside = reflect(inside, inward);
            left *= 1 - through;
        }
    }
    Vector centre_;
    double radius_, ior_;
};

template <typename Shape>
void splat_all(Film& film, std::uint64_t samples, std::uint64_t seed) {
    const Shape shape;
    Random random(seed);
    const auto side = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(samples)));
    const double step = 1 / static_cast<double>(side), share = step * step;
    for (std::uint64_t row = 0; row < side; ++row) {
        for (std::uint64_t column = 0; column < side; ++column) {
            const double u = (static_cast<double>(column) + random.next()) * step,
                         v = (static_cast<double>(row) + random.next()) * step;
            shape.splat(film, u, v, share);
        }
    }
}

}  // namespace

int main(int count, char** words) {
    if (count != 5) {
        std::fprintf(stderr, "usage: splat pool|ring|ball SAMPLES SEED FILE < NUMBERS\n");
        return 2;
    }
    const std::uint64_t samples = std::strtoull(words[2], nullptr, 10),
                        seed = std::strtoull(words[3], nullptr, 10);
    Film film;
    if (std::strcmp(words[1], "pool") == 0) {
        splat_all<Pool>(film, samples, seed);
    } else if (std::strcmp(words[1], "ring") == 0) {
        splat_all<Ring>(film, samples, seed);
    } else if (std::strcmp(words[1], "ball") == 0) {
        splat_all<Ball>(film, samples, seed);
    } else {
        std::fprintf(stderr, "splat: no shape %s (known: pool, ring, ball)\n", words[1]);
        return 2;
    }
    if (!film.write(words[4])) {
        std::fprintf(stderr, "splat: %s: cannot be written\n", words[4]);
        return 1;
    }
    return 0;
}
