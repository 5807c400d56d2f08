#pragma once

#include "branch/orbit_condition.hpp"
#include "flow/cyclic.hpp"
#include "graze/branch/continuation.hpp"
#include "graze/branch/orbit_branch.hpp"
#include "orbit/orbit_equations.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// The equations of a periodic orbit with a free parameter, for continuation; with monitors that are held, and as many
/// further parameters.
class OrbitProblem : public ContinuationProblem {
public:
    OrbitProblem(const Simulation& simulation, const Orbit& orbit, ParameterId parameter);
    /// By any discretisation. @param equations with one free parameter
    explicit OrbitProblem(std::unique_ptr<OrbitEquations> equations);
    /// With further free parameters, as many as conditions are to be held.
    OrbitProblem(const Simulation& simulation, const Orbit& orbit, const BranchSettings& settings);
    /// @param conditions which must outlive this
    void hold(std::span<const std::unique_ptr<OrbitCondition>> conditions) {
        held_ = conditions;
        at_.unknowns.resize(0); // which has been evaluated without them
    }

    OrbitEquations& equations() { return *equations_; }
    const OrbitEquations& equations() const { return *equations_; }
    std::size_t parameter_place() const { return equations_->layout().parameter(0); }
    std::vector<double> unknowns_of(const Orbit& orbit);
    Orbit orbit_of(std::span<const double> u) const { return equations_->orbit_of(vector_of(u)); }

    /// The evaluation that is at hand: of the last unknowns at which there was one.
    const OrbitEvaluation& evaluation() const { return at_; }
    /// Why nothing could be evaluated or solved, if that is known.
    virtual std::string problem() const { return at_.problem; }
    /// Unknowns that change as the orbit does, at the last evaluation. @throws InputError when the direction does not
    /// fit the orbit
    std::vector<double> unknowns_of(const OrbitDirection& direction) const;
    OrbitDirection direction_of(std::span<const double> u) const { return equations_->direction_of(vector_of(u)); }

    std::size_t unknowns() const override { return equations_->unknowns(); }
    std::span<const double> scales() const override {
        return {equations_->scales().data(), static_cast<std::size_t>(equations_->scales().size())};
    }
    /// Pieces of a segment count together as much as one, and inner unknowns nothing: lengths are those of the orbit,
    /// however it is laid out. Many states or segments count together as much as a few.
    std::span<const double> weights() const override { return weights_; }
    /// The row whose product with vectors is that with a direction, in units of the scales.
    std::vector<double> row_of(std::span<const double> direction) const;
    /// Asked again for where it has been evaluated last, as after Newton's method, it does nothing.
    bool evaluate(std::span<const double> u) override;
    bool solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
               double* determinant) override;
    bool has_chords() const override { return held_.empty() && equations_->has_chords(); }
    bool derivatives_are_expensive() const override { return equations_->derivatives_are_expensive(); }
    bool chord(std::span<const double> u, std::span<const double> row, std::span<double> step) override;
    void accept(std::span<const double> u) override {
        // Scales need not be exact: what they cost is saved most of the time.
        constexpr std::size_t renewal = 5;
        if (at_.is_at(vector_of(u)))
            for (const auto& condition : held_)
                condition->renew(*equations_, at_);
        if (accepted_++ % renewal == 0)
            equations_->set_scales(vector_of(u));
    }

    void reduce(std::span<double> difference) const override {
        const std::vector<double>& periods = at_.periods;
        for (std::size_t k = 0; k < equations_->layout().pieces(); ++k)
            for (std::size_t i = 0; i < periods.size(); ++i) {
                double& one = difference[equations_->layout().start_of(k) + i];
                one = without_turns(one, periods[i]);
            }
    }

    static Eigen::Map<const Eigen::VectorXd> vector_of(std::span<const double> values) {
        return {values.data(), static_cast<Eigen::Index>(values.size())};
    }

private:
    bool evaluate_held();
    const OrbitEquations::Closed& closed_by(std::span<const double> row);

    std::unique_ptr<OrbitEquations> equations_;
    OrbitEvaluation at_;
    std::vector<double> weights_;
    std::span<const std::unique_ptr<OrbitCondition>> held_;
    Eigen::MatrixXd rows_;      ///< gradients of the conditions that are held
    Eigen::VectorXd residuals_; ///< how far they are off
    std::vector<double> row_;   ///< which, with the conditions, closes the equations at the evaluation; or none
    OrbitEquations::Closed closed_;
    std::size_t accepted_ = 0;
};

} // namespace graze
