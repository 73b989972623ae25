#pragma once

namespace caustics::photonmap {

struct SineCosine {
    float sine;
    float cosine;
};

/// Sines and cosines at the centres of a direction code's 256 cells of theta and of phi: the
/// direction is (sin theta cos phi, sin theta sin phi, cos theta). Plain data, so that code for any
/// instruction set can read it.
struct DirectionTables {
    SineCosine theta[256];
    SineCosine phi[256];

    // The first half of theta and the first quarter of phi once more, in columns that fit into
    // registers. The rest mirrors them exactly.
    alignas(64) float theta_sine[128];
    float theta_cosine[128];
    float phi_sine[64];
    float phi_cosine[64];
};

/// The one copy; `decode_direction` reads it too.
const DirectionTables& direction_tables();

}  // namespace caustics::photonmap
