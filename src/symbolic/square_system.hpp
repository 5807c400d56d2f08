#pragma once

#include "graze/symbolic/function.hpp"
#include "graze/symbolic/interval.hpp"
#include "graze/symbolic/zero_search.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// A square matrix of intervals.
class IntervalMatrix {
public:
    explicit IntervalMatrix(std::size_t size) : size_(size), entries_(size * size) {}
    std::size_t size() const { return size_; }
    Interval& operator()(std::size_t row, std::size_t column) { return entries_[row * size_ + column]; }
    const Interval& operator()(std::size_t row, std::size_t column) const { return entries_[row * size_ + column]; }
    std::span<const Interval> row(std::size_t index) const { return std::span(entries_).subspan(index * size_, size_); }

private:
    std::size_t size_;
    std::vector<Interval> entries_;
};

/// n functions of n unknowns with their derivatives, at fixed parameters; evaluated at points and over boxes. For use
/// by one thread.
class SquareSystem {
public:
    /// @param unknowns their number; @param function as for find_zeros. @throws InputError unless the numbers fit
    SquareSystem(const Function& function, std::size_t unknowns, std::span<const double> parameters);

    std::size_t size() const { return size_; }

    struct Point {
        Eigen::VectorXd values;
        Eigen::MatrixXd derivatives;
    };
    /// @return none where something is not finite
    std::optional<Point> at(std::span<const double> unknowns);

    struct Bounds {
        IntervalBox values;
        IntervalMatrix derivatives;
        /// True if all functions are continuous, with bounded derivatives.
        bool smooth() const;
    };
    Bounds over(std::span<const Interval> box);
    /// Bounds the round-off of the values at a point.
    IntervalBox values_at(std::span<const double> unknowns);
    /// Shrinks a box, the last one given to `over`, without losing zeros; false if it has none.
    bool narrow(IntervalBox& box);

private:
    void enclose(std::span<const Interval> box);

    const Function& function_;
    std::size_t size_;
    std::vector<double> inputs_, results_, work_;
    std::vector<Interval> boxes_, bounds_, interval_work_;
};

/// Returns the inverse of a matrix whose rows and columns may have different units. @param scales of the columns
/// @return none if it is singular to working precision
std::optional<Eigen::MatrixXd> scaled_inverse(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& scales);

/// Returns point matrix times interval matrix.
IntervalMatrix product(const Eigen::MatrixXd& left, const IntervalMatrix& right);
IntervalBox product(const Eigen::MatrixXd& left, const IntervalBox& right);

} // namespace graze
