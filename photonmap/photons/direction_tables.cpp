#include "photonmap/photons/direction_tables.h"

#include <cmath>

#include "core/math/vec.h"

namespace caustics::photonmap {

namespace {

void tabulate_theta(DirectionTables& tables) {
    for (int i = 0; i < 128; ++i) {
        const double angle = (i + 0.5) * pi_d / 256;
        tables.theta_sine[i] = static_cast<float>(std::sin(angle));
        tables.theta_cosine[i] = static_cast<float>(std::cos(angle));
        tables.theta[i] = {tables.theta_sine[i], tables.theta_cosine[i]};
        tables.theta[255 - i] = {tables.theta_sine[i], -tables.theta_cosine[i]};
    }
}

void tabulate_phi(DirectionTables& tables) {
    for (int i = 0; i < 64; ++i) {
        const double angle = (i + 0.5) * pi_d / 128;
        const auto sine = tables.phi_sine[i] = static_cast<float>(std::sin(angle));
        const auto cosine = tables.phi_cosine[i] = static_cast<float>(std::cos(angle));
        tables.phi[i] = {sine, cosine};
        tables.phi[127 - i] = {sine, -cosine};
        tables.phi[128 + i] = {-sine, -cosine};
        tables.phi[255 - i] = {-sine, cosine};
    }
}

const DirectionTables tables = [] {
    DirectionTables all{};
    tabulate_theta(all);
    tabulate_phi(all);
    return all;
}();

}  // namespace

const DirectionTables& direction_tables() { return tables; }

}  // namespace caustics::photonmap
