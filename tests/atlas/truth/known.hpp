// What the atlas must find in models whose orbits are known in closed form.

#pragma once

#include <vector>

namespace graze::testing::truth {

/// The ranges of two parameters in which a header gives the full answer for orbits of at most `multiple` returns.
struct Box {
    const char *first, *second; ///< the parameters
    double first_low, first_high, second_low, second_high;
    unsigned multiple;

    bool contains(double p, double q) const {
        return first_low <= p && p <= first_high && second_low <= q && q <= second_high;
    }
};

/// A point of codimension two, or a turn of a curve (EX).
struct Joint {
    const char* type; ///< as `graze points` calls it
    unsigned period;  ///< of its orbit, in returns
    double first, second;
};

/// Returns the second parameter at each point of a curve with a given value of the first one, also outside the box. At
/// the ends of a curve, which are joints, there may be none because of round-off.
using Curve = std::vector<double> (*)(double first);

struct NamedCurve {
    const char* type;
    unsigned period;
    unsigned contacts; ///< in one period
    Curve at;
};

} // namespace graze::testing::truth
