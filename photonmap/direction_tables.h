#pragma once

namespace caustics {

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
};

/// The one copy; `decode_direction` reads it too.
const DirectionTables& direction_tables();

}  // namespace caustics
