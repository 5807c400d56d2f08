#include "symbolic/square_system.hpp"

#include "base/linear_systems.hpp"
#include "graze/base/require.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

Eigen::Index at_index(std::size_t index) {
    return static_cast<Eigen::Index>(index);
}

} // namespace

SquareSystem::SquareSystem(const Function& function, std::size_t unknowns, std::span<const double> parameters)
    : function_(function), size_(unknowns), inputs_(function.inputs()), results_(function.outputs()),
      work_(function.workspace()), boxes_(function.inputs()), bounds_(function.outputs()),
      interval_work_(function.workspace()) {
    require_size(function.inputs(), unknowns + parameters.size(), "inputs of functions of which zeros are looked for");
    require_size(function.outputs(), unknowns + unknowns * unknowns, "functions and derivatives");
    require_finite(parameters, "a parameter of functions of which zeros are looked for");
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        inputs_[unknowns + i] = parameters[i];
        boxes_[unknowns + i] = Interval::point(parameters[i]);
    }
}

std::optional<SquareSystem::Point> SquareSystem::at(std::span<const double> unknowns) {
    std::ranges::copy(unknowns, inputs_.begin());
    function_.evaluate(inputs_, results_, work_);
    if (!std::ranges::all_of(results_, [](double value) { return std::isfinite(value); }))
        return std::nullopt;
    const auto n = at_index(size_);
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    return Point{Eigen::Map<const Eigen::VectorXd>(results_.data(), n),
                 Eigen::Map<const RowMajor>(results_.data() + n, n, n)};
}

void SquareSystem::enclose(std::span<const Interval> box) {
    std::ranges::copy(box, boxes_.begin());
    function_.enclose(boxes_, bounds_, interval_work_);
}

SquareSystem::Bounds SquareSystem::over(std::span<const Interval> box) {
    enclose(box);
    Bounds bounds{IntervalBox(bounds_.begin(), bounds_.begin() + static_cast<std::ptrdiff_t>(size_)),
                  IntervalMatrix(size_)};
    for (std::size_t row = 0; row < size_; ++row)
        for (std::size_t column = 0; column < size_; ++column)
            bounds.derivatives(row, column) = bounds_[size_ + row * size_ + column];
    return bounds;
}

bool SquareSystem::Bounds::smooth() const {
    for (std::size_t row = 0; row < values.size(); ++row) {
        if (!values[row].continuous)
            return false;
        for (std::size_t column = 0; column < values.size(); ++column)
            if (!derivatives(row, column).continuous || !derivatives(row, column).bounded())
                return false;
    }
    return true;
}

IntervalBox SquareSystem::values_at(std::span<const double> unknowns) {
    IntervalBox box;
    for (const double value : unknowns)
        box.push_back(Interval::point(value));
    enclose(box);
    return {bounds_.begin(), bounds_.begin() + static_cast<std::ptrdiff_t>(size_)};
}

bool SquareSystem::narrow(IntervalBox& box) {
    const std::vector<Interval> zeros(size_);
    if (!function_.narrow(boxes_, zeros, interval_work_))
        return false;
    std::copy_n(boxes_.begin(), size_, box.begin());
    // The parameters may have been narrowed too: to themselves, or to nothing if there is no zero.
    return true;
}

std::optional<Eigen::MatrixXd> scaled_inverse(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& scales) {
    Eigen::MatrixXd scaled = matrix * scales.asDiagonal();
    const Eigen::VectorXd rows = scaled.cwiseAbs().rowwise().maxCoeff();
    if (!rows.allFinite() || !(rows.minCoeff() > 0))
        return std::nullopt;
    scaled = rows.cwiseInverse().asDiagonal() * scaled;
    const Eigen::MatrixXd inverse =
        scales.asDiagonal() * PartialLU(scaled).inverse() * rows.cwiseInverse().asDiagonal();
    return inverse.allFinite() ? std::optional(inverse) : std::nullopt;
}

IntervalMatrix product(const Eigen::MatrixXd& left, const IntervalMatrix& right) {
    IntervalMatrix result(right.size());
    for (std::size_t row = 0; row < right.size(); ++row)
        for (std::size_t column = 0; column < right.size(); ++column)
            for (std::size_t k = 0; k < right.size(); ++k)
                result(row, column) =
                    result(row, column) + Interval::point(left(at_index(row), at_index(k))) * right(k, column);
    return result;
}

IntervalBox product(const Eigen::MatrixXd& left, const IntervalBox& right) {
    IntervalBox result(right.size());
    for (std::size_t row = 0; row < right.size(); ++row)
        for (std::size_t k = 0; k < right.size(); ++k)
            result[row] = result[row] + Interval::point(left(at_index(row), at_index(k))) * right[k];
    return result;
}

} // namespace graze
