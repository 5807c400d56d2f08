#include "graze/layout/etched_wall.hpp"

namespace graze {

double EtchedWidth::mean_cube() const {
    // Integral of the cube of a linear function, factored to avoid cancellation of fourth powers.
    return 0.25 * (top + bottom) * (top * top + bottom * bottom);
}

EtchedWidth etched_line(const EtchedWall& wall, double drawn, double depth) {
    return {drawn - 2 * wall.recess(0), drawn - 2 * wall.recess(depth)};
}

EtchedWidth etched_trench(const EtchedWall& wall, double drawn, double depth) {
    return {drawn + 2 * wall.recess(0), drawn + 2 * wall.recess(depth)};
}

} // namespace graze
