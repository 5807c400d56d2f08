#pragma once

#include "graze/branch/continuation.hpp"
#include "orbit/shooting.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>

namespace graze {

/// The equations of a periodic orbit with one free parameter, for continuation.
class OrbitProblem : public ContinuationProblem {
public:
    OrbitProblem(const Simulation& simulation, const Orbit& orbit, std::size_t parameter)
        : shooting_(simulation, orbit, {parameter}) {}

    Shooting& shooting() { return shooting_; }
    const Shooting& shooting() const { return shooting_; }
    std::size_t parameter_place() const { return shooting_.place_of_parameter(0); }

    std::size_t unknowns() const override { return shooting_.unknowns(); }
    std::span<const double> scales() const override {
        return {shooting_.scales().data(), static_cast<std::size_t>(shooting_.scales().size())};
    }
    bool evaluate(std::span<const double> u) override { return shooting_.evaluate(vector_of(u)); }
    bool solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
               double* determinant) override {
        Eigen::VectorXd result;
        const Eigen::VectorXd value = Eigen::VectorXd::Constant(1, right);
        if (!shooting_.solve(vector_of(row).transpose(), value, homogeneous, result, determinant))
            return false;
        Eigen::Map<Eigen::VectorXd>(step.data(), result.size()) = result;
        return true;
    }
    void accept(std::span<const double> u) override {
        // Scales need not be exact: what they cost is saved most of the time.
        constexpr std::size_t renewal = 5;
        if (accepted_++ % renewal == 0)
            shooting_.set_scales(vector_of(u));
    }

    static Eigen::Map<const Eigen::VectorXd> vector_of(std::span<const double> values) {
        return {values.data(), static_cast<Eigen::Index>(values.size())};
    }

private:
    Shooting shooting_;
    std::size_t accepted_ = 0;
};

} // namespace graze
