#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/material/wavelength.h"

namespace caustics {

/// A medium's index of refraction: a number, or a law of the wavelength (dispersion) [C11].
class Ior {
public:
    Ior(float n) : n_(n) {}
    /// n = a + b / l^2, l the wavelength [um], b [um^2].
    static Ior cauchy(double a, double b);
    /// n^2 = 1 + sum of b l^2 / (l^2 - c), l the wavelength [um], c [um^2].
    struct SellmeierTerm {
        double b;
        double c;
    };
    static Ior sellmeier(std::vector<SellmeierTerm> terms);
    /// Cauchy's law through n_d with Abbe's number V_d = (n_d - 1) / (n_F - n_C).
    static Ior abbe(double n_d, double v_d);

    /// A law that gives one number everywhere is none.
    bool is_dispersive() const { return is_dispersive_; }
    /// At a wavelength [nm]; 0 stands for the d line. Double precision for a law.
    double at(float nm) const { return is_dispersive_ ? by_law(nm == 0 ? d_line : nm) : n(); }
    /// At the d line.
    double n() const { return static_cast<double>(n_); }

    /// Why the law cannot be used between 380 and 730 nm, if so: there n is finite and 1 or more.
    std::optional<std::string> why_unusable() const;
    /// What makes two laws different, for hashes: n, or the terms.
    std::vector<double> numbers() const;

    bool operator==(const Ior& other) const { return numbers() == other.numbers(); }

private:
    enum class Law { constant, cauchy, sellmeier };
    Ior(Law law, std::vector<SellmeierTerm> terms);
    double by_law(float nm) const;

    float n_;
    bool is_dispersive_ = false;
    Law law_ = Law::constant;
    std::vector<SellmeierTerm> terms_;  ///< of Cauchy's law: one, (a, b)
};

/// A glass of a catalogue.
struct NamedGlass {
    const char* name;
    std::vector<Ior::SellmeierTerm> terms;
    double n_d, v_d;  ///< that the catalogue gives beside the terms
};
/// Those known by name: Schott's catalogue, fused silica by Malitson (1965), water at 20 degrees by
/// Daimon and Masumura (2007).
const std::vector<NamedGlass>& named_glasses();
/// Their names, with commas between them.
std::string named_glass_list();

}  // namespace caustics
