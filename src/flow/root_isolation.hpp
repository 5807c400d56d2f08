#pragma once

#include "graze/flow/roots.hpp"

#include "bernstein.hpp"
#include "root_tracker.hpp"

#include <cstddef>
#include <span>

namespace graze {

/// Isolation of the roots of one polynomial: its scaled Bernstein form, subdivided depth first, left part first.
class RootFinder::Isolation {
public:
    /// Parts that begin at 0 are halved until roots as close to 0 as 2^-64 of the step are separated, others until few
    /// numbers are left inside; together they never need more rows than this.
    static constexpr std::size_t stack_rows = 120;

    /// @param c coefficients of the polynomial; with `deflate` the first is taken as 0
    /// @throws InputError if the degree is higher than the finder's highest
    Isolation(RootFinder& finder, std::span<const double> c, double length, RootStart start);

    /// True when the polynomial is finite and not identically zero.
    bool usable() const { return usable_; }
    std::span<const double> power() const { return power_; }
    /// The polynomial with its roots at 0 divided out.
    std::span<const double> quotient() const { return power_.subspan(zeros_); }
    int sign_at_start() const { return quotient()[0] > 0 ? 1 : -1; }

    /// Samples the polynomial from left to right, as densely as its roots and touches require.
    /// @return false if a falling root ended the search (see roots::Tracker)
    bool scan(roots::Tracker& tracker);
    Minimum minimum();

private:
    RootFinder& finder_;
    double length_;
    std::span<const double> power_, slope_, reciprocals_;
    std::size_t zeros_ = 0;       ///< leading zero coefficients of the polynomial
    std::size_t slope_zeros_ = 0; ///< leading zero coefficients of its derivative
    bool slope_ready_ = false, usable_ = false;
    double first_scale_ = 0;

    std::span<BernsteinCoefficient> row(std::size_t i) {
        return {finder_.coefficients_.get() + i * finder_.power_.size(), power_.size()};
    }
    bool is_fresh(const Node& node) const { return node.floor > 0 && node.scale <= first_scale_; }
    double place(double t) const { return length_ * t; }
    double round_off(int halvings_and_conversion) const {
        return bernstein::unit_roundoff * halvings_and_conversion * static_cast<double>(power_.size());
    }

    void load(std::size_t size);
    void prepare_slope();
    bool locate_extremum(const Node& node, std::span<const BernsteinCoefficient> b, double& at, bool& is_minimum);
    bool leaf(roots::Tracker& tracker, const Node& node, std::span<const BernsteinCoefficient> b, bool extremum);
    bool definite(roots::Tracker& tracker, const Node& node, int sign);
    double control_polygon_root(const Node& node, std::span<const BernsteinCoefficient> b) const;
    double slope_polygon_root(const Node& node, std::span<const BernsteinCoefficient> b) const;
    bool split(const bernstein::Range& range);
    bool renew(Node& node, std::span<BernsteinCoefficient> b);
    double lower_bound_near(double at, const roots::PointValue& point, double left, double right);
};

} // namespace graze
