#pragma once

#include "branch/monitor_function.hpp"
#include "graze/branch/continuation.hpp"
#include "graze/branch/monitor.hpp"
#include "graze/branch/orbit_branch.hpp"
#include "orbit/shooting.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// The equations of a periodic orbit with a free parameter, for continuation; with monitors that are held, and as many
/// further parameters.
class OrbitProblem : public ContinuationProblem {
public:
    OrbitProblem(const Simulation& simulation, const Orbit& orbit, std::size_t parameter)
        : shooting_(simulation, orbit, {parameter}) {}
    /// @param monitors those that are fixed count, and say at which value; may be null
    OrbitProblem(const Simulation& simulation, const Orbit& orbit, const BranchSettings& settings,
                 const OrbitMonitors* monitors);

    Shooting& shooting() { return shooting_; }
    const Shooting& shooting() const { return shooting_; }
    std::size_t parameter_place() const { return shooting_.place_of_parameter(0); }

    std::size_t unknowns() const override { return shooting_.unknowns(); }
    std::span<const double> scales() const override {
        return {shooting_.scales().data(), static_cast<std::size_t>(shooting_.scales().size())};
    }
    /// The row whose product with vectors is that with a direction, in units of the scales.
    std::vector<double> row_of(std::span<const double> direction) const;
    bool evaluate(std::span<const double> u) override;
    bool solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
               double* determinant) override;
    void accept(std::span<const double> u) override {
        // Scales need not be exact: what they cost is saved most of the time.
        constexpr std::size_t renewal = 5;
        if (accepted_++ % renewal == 0)
            shooting_.set_scales(vector_of(u));
    }

    void reduce(std::span<double> difference) const override {
        const std::vector<double>& periods = shooting_.periods();
        for (std::size_t k = 0; k < shooting_.pieces(); ++k)
            for (std::size_t i = 0; i < periods.size(); ++i)
                if (periods[i] > 0) {
                    double& one = difference[shooting_.start_of(k) + i];
                    one -= std::round(one / periods[i]) * periods[i];
                }
    }

    static Eigen::Map<const Eigen::VectorXd> vector_of(std::span<const double> values) {
        return {values.data(), static_cast<Eigen::Index>(values.size())};
    }

private:
    /// A monitor that is held, and the value at which it is.
    struct Held {
        double value;
        std::unique_ptr<MonitorFunction> function;
    };
    bool evaluate_held(const Eigen::VectorXd& u);

    Shooting shooting_;
    std::vector<Held> held_;
    Eigen::MatrixXd rows_;      ///< gradients of the monitors that are held
    Eigen::VectorXd residuals_; ///< how far they are off
    std::size_t accepted_ = 0;
};

} // namespace graze
