#pragma once

#include "graze/flow/roots.hpp"

#include <span>
#include <vector>

namespace graze::roots {

/// The value of a polynomial at one point, with the error bounds of the class RootFinder.
struct PointValue {
    double value, slope;
    double size;        ///< sum |c_k| s^k
    double value_error; ///< error(s)
    double slope_error;

    /// Returns the sign, or 0 where round-off hides it.
    int sign() const { return (value > value_error) - (value < -value_error); }
    int slope_sign() const { return (slope > slope_error) - (slope < -slope_error); }
};

PointValue evaluate(std::span<const double> c, double s);

/// Newton iteration safeguarded by a bracket at whose ends c has opposite signs, until round-off decides.
double refine(std::span<const double> c, double low, double high, int sign_low, double guess);

/// Combines the samples of the isolation, taken from left to right, into crossings and touches. Between two samples
/// with opposite certain signs there is one crossing; uncertain samples between equal signs are a touch.
class Tracker {
public:
    /// @param quotient the polynomial with its roots at 0 divided out: crossings are refined on it
    Tracker(std::span<const double> power, std::span<const double> quotient, int sign_at_start)
        : power_(power), quotient_(quotient), sign_(sign_at_start) {}

    bool only_first_falling = false;
    double touch = 0;
    std::vector<Root>* touches = nullptr;
    std::vector<Root>* crossings = nullptr;
    Root first{}; ///< the falling root that ended the search

    /// Adds a sample with a certain sign.
    /// @param guess estimate of a crossing before `at`
    /// @return whether to continue
    bool certain(double at, int sign, double guess);

    /// Adds a sample whose sign is determined from the value.
    /// @param minimum whether this is a local minimum
    bool sample(double at, const PointValue& point, bool minimum, double guess);

    /// Applies the rule for the end of the interval (see the class RootFinder).
    /// @return false if a falling root ends the search
    bool finish(double length);

private:
    std::span<const double> power_, quotient_;
    double at_ = 0; ///< last sample with a certain sign
    int sign_;
    bool pending_ = false; ///< uncertain samples have followed it
    Root pending_touch_{};
    double last_touch_ = 0;

    bool report_crossing(double at);
    void report_pending_touch();
    void report_touch(const Root& root);
    bool ends_in_minimum(double length) const;
};

} // namespace graze::roots
