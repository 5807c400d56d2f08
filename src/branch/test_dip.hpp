#pragma once

#include <functional>
#include <optional>

namespace graze {

/// The value of a test function at a fraction of the last step.
struct TestValue {
    double fraction = 0, value = 0;
};

/// Values of a test before, between and behind two of its zeros.
struct Dip {
    TestValue before, within, behind;
};

/// Returns where a test may have two zeros between the last two of four points with values of one sign: where the
/// parabola through the last three, less its difference from the cubic through all, is least, if that is near zero or
/// of the other sign.
/// @param oldest its value is NaN if there are only three points
std::optional<double> possible_dip(const TestValue& oldest, const TestValue& before, const TestValue& low,
                                   const TestValue& high);
/// Searches for a value of the other sign between two values of the same sign, with parabolas through three values that
/// come ever closer: the two zeros may be much closer to each other than the ends are to them.
/// @param within estimate of the extremum; @param noise values up to it are zero or unknown
/// @param value_at the test at a fraction, NaN where it is not defined
std::optional<Dip> dip_between(const TestValue& low, const TestValue& high, double within, double noise,
                               const std::function<double(double)>& value_at);

} // namespace graze
