#include "core/material/ior.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace caustics {

Ior::Ior(Law law, std::vector<SellmeierTerm> terms) : n_(0), law_(law), terms_(std::move(terms)) {
    n_ = static_cast<float>(by_law(d_line));
    for (double nm = shortest_wavelength; nm <= longest_wavelength; nm += 1)
        is_dispersive_ = is_dispersive_ || static_cast<float>(by_law(static_cast<float>(nm))) != n_;
}

Ior Ior::cauchy(double a, double b) { return {Law::cauchy, {{a, b}}}; }

Ior Ior::sellmeier(std::vector<SellmeierTerm> terms) {
    // 0 / 0 at its pole.
    std::erase_if(terms, [](const SellmeierTerm& term) { return term.b == 0; });
    return {Law::sellmeier, std::move(terms)};
}

// With l_F, l_C, l_d = 0.4861327, 0.6562725, 0.5875618 um.
Ior Ior::abbe(double n_d, double v_d) {
    constexpr auto per_square = [](double um) { return 1 / (um * um); };
    const double b = (n_d - 1) / v_d / (per_square(0.4861327) - per_square(0.6562725));
    return cauchy(n_d - b * per_square(0.5875618), b);
}

double Ior::by_law(float nm) const {
    const double um = static_cast<double>(nm) * 1e-3;
    const double square = um * um;
    if (law_ == Law::cauchy) return terms_[0].b + terms_[0].c / square;
    double n2 = 1;
    for (const SellmeierTerm& term : terms_) n2 += term.b * square / (square - term.c);
    return std::sqrt(n2);
}

std::optional<std::string> Ior::why_unusable() const {
    if (law_ == Law::constant) return {};
    const auto at = [](double nm) { return " at " + std::to_string(std::lround(nm)) + " nm"; };
    if (law_ == Law::sellmeier)
        for (const SellmeierTerm& term : terms_) {
            const double pole = term.c > 0 ? 1e3 * std::sqrt(term.c) : 0;
            if (pole >= shortest_wavelength && pole <= longest_wavelength)
                return "the index is infinite" + at(pole);
        }
    for (double nm = shortest_wavelength; nm <= longest_wavelength; nm += 1) {
        const double n = by_law(static_cast<float>(nm));
        if (!std::isfinite(n)) return "the index is not finite" + at(nm);
        if (n < 1) return "the index is " + std::to_string(n) + at(nm) + ", below 1";
        if (n > 10) return "the index is " + std::to_string(n) + at(nm) + ", above 10";
    }
    return {};
}

std::vector<double> Ior::numbers() const {
    if (!is_dispersive_) return {n()};
    std::vector<double> numbers = {static_cast<double>(law_)};
    for (const SellmeierTerm& term : terms_) {
        numbers.push_back(term.b);
        numbers.push_back(term.c);
    }
    return numbers;
}

const std::vector<NamedGlass>& named_glasses() {
    constexpr auto squared = [](double um) { return um * um; };
    static const std::vector<NamedGlass> glasses = {
        {"bk7",
         {{1.03961212, 0.00600069867}, {0.231792344, 0.0200179144}, {1.01046945, 103.560653}},
         1.51680,
         64.17},
        {"f2",
         {{1.34533359, 0.00997743871}, {0.209073176, 0.0470450767}, {0.937357162, 111.886764}},
         1.62004,
         36.37},
        {"sf5",
         {{1.46141885, 0.0111826126}, {0.247713019, 0.0508594669}, {0.949995832, 112.041888}},
         1.67270,
         32.21},
        {"sf10",
         {{1.61625977, 0.0127534559}, {0.259229334, 0.0581983954}, {1.07762317, 116.60768}},
         1.72825,
         28.41},
        {"fused silica",
         {{0.6961663, squared(0.0684043)},
          {0.4079426, squared(0.1162414)},
          {0.8974794, squared(9.896161)}},
         1.45846,
         67.82},
        {"water",
         {{0.5684027565, 0.005101829712},
          {0.1726177391, 0.01821153936},
          {0.02086189578, 0.02620722293},
          {0.1130748688, 10.69792721}},
         1.33334,
         55.79}};
    return glasses;
}

std::string named_glass_list() {
    std::string list;
    for (const NamedGlass& glass : named_glasses())
        list += (list.empty() ? "" : ", ") + std::string(glass.name);
    return list;
}

}  // namespace caustics
