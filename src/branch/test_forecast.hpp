#pragma once

#include "branch/point_kind.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace graze {

/// Predicts the tests of a branch from their values at its last points, and with them how long a step may be for no
/// special point to be passed over: steps that are longer than usual are made only where no test comes near zero, and
/// are repeated where the tests are not as predicted.
class TestForecast {
public:
    void forget() { points_.clear(); }
    /// Adds a point of the branch, in their order.
    void add(double arclength, const std::vector<BranchTest>& tests);
    /// Changes to new units, in which the last point has other tests; those of the points before change in proportion.
    /// @param length that a part of the branch of length 1 has in the new units
    void rescale(double length, const std::vector<BranchTest>& tests);
    /// Returns the length of the next step: the longest, or a half, a quarter and so on of it, within which, and
    /// in some usual steps behind it, no test may come near zero; the usual length where this is not known.
    double length(double usual, double longest) const;
    /// True when the tests of the next point are as predicted.
    bool foresees(double arclength, const std::vector<BranchTest>& tests) const;

private:
    struct Point {
        double arclength = 0;
        std::vector<double> values; ///< NaN where a test is not defined, or says nothing
    };
    /// The cubic through the last four values of a test.
    struct Prediction {
        double value = 0, uncertainty = 0;
    };
    static constexpr std::size_t count = 4;
    Prediction predict(std::size_t test, double arclength) const;
    bool stays_away(std::size_t test, double length) const;
    static std::vector<double> values_of(const std::vector<BranchTest>& tests);

    std::vector<Point> points_; ///< the newest is the last
};

} // namespace graze
