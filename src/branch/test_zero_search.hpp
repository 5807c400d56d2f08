#pragma once

#include "branch/crossing.hpp"

#include <optional>
#include <vector>

namespace graze {

/// Searches for the zero of a test function with few evaluations: by inverse interpolation through the last values,
/// kept within a bracket, and by halving the bracket where that does not help (R. P. Brent, "Algorithms for
/// Minimization without Derivatives", 1973; G. E. Alefeld, F. A. Potra and Y. Shi, ACM Trans. Math. Softw. 21, 1995).
///
/// A value that is not a number, as of a minimum that does not exist yet, counts as positive, but of unknown size.
class TestZeroSearch {
public:
    /// @param low, high where the test has different signs
    /// @param within accuracy of the zero, as a fraction of the step
    /// @param outside another value of the test, if known: it improves the first estimate
    TestZeroSearch(TestValue low, TestValue high, double within, std::optional<TestValue> outside = std::nullopt);

    /// Returns where the test is to be evaluated next; empty: the last place is the zero.
    std::optional<double> next();
    /// Adds the value of the test at the place that `next` has returned.
    void add(double value);
    /// Ends of the bracket.
    const TestValue& low() const { return low_; }
    const TestValue& high() const { return high_; }

private:
    std::optional<double> interpolated() const;

    TestValue low_, high_;
    double within_;
    std::vector<TestValue> others_; ///< values outside the bracket, the last ones first
    std::optional<TestValue> last_;
    double before_ = 0;     ///< the value before the last one
    double place_ = 0;      ///< where the test is evaluated next
    double width_ = 1;      ///< of the bracket two evaluations ago
    double first_size_ = 0; ///< of the values at the first bracket
    double size_ = 0;       ///< of the value two evaluations ago
    int evaluations_ = 0;
};

} // namespace graze
