#pragma once

#include "branch/orbit_condition.hpp"
#include "flow/cyclic.hpp"
#include "graze/branch/continuation.hpp"
#include "graze/branch/orbit_branch.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/orbit_equations.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// The equations of a periodic orbit with a free parameter as a continuation problem, optionally with held conditions
/// and as many additional free parameters.
class OrbitProblem : public ContinuationProblem {
public:
    OrbitProblem(const Simulation& simulation, const Orbit& orbit, ParameterId parameter);
    /// For any discretisation. @param equations with one free parameter
    explicit OrbitProblem(std::unique_ptr<OrbitEquations> equations);
    /// With additional free parameters, one for each condition that will be held.
    OrbitProblem(const Simulation& simulation, const Orbit& orbit, const BranchSettings& settings);
    /// @param conditions must outlive this object
    void hold(std::span<const std::unique_ptr<OrbitCondition>> conditions) {
        held_ = conditions;
        at_.unknowns.resize(0); // evaluated without the conditions
    }

    OrbitEquations& equations() { return *equations_; }
    const OrbitEquations& equations() const { return *equations_; }
    std::size_t parameter_place() const { return equations_->layout().parameter(0); }
    std::vector<double> unknowns_of(const Orbit& orbit) { return numbers_of(equations_->unknowns_of(orbit)); }
    Orbit orbit_of(std::span<const double> u) const { return equations_->orbit_of(vector_of(u)); }

    /// The last evaluation.
    const OrbitEvaluation& evaluation() const { return at_; }
    /// Why the last evaluation or solution failed, if known.
    virtual std::string problem() const { return at_.problem; }
    /// Converts a direction of the orbit to one of the unknowns, at the last evaluation. @throws InputError when the
    /// direction does not fit the orbit
    std::vector<double> unknowns_of(const OrbitDirection& direction) const {
        return numbers_of(equations_->unknowns_of(direction, at_));
    }
    OrbitDirection direction_of(std::span<const double> u) const { return equations_->direction_of(vector_of(u)); }
    /// Returns the tangent of the branch through an orbit along which the parameter changes at this rate; empty where
    /// there is none, as at a fold.
    std::optional<OrbitDirection> tangent_at(const Orbit& orbit, double rate);

    std::size_t unknowns() const override { return equations_->unknowns(); }
    std::span<const double> scales() const override {
        return {equations_->scales().data(), static_cast<std::size_t>(equations_->scales().size())};
    }
    /// All pieces of a segment together have the weight of one, and inner unknowns have none, so that lengths do not
    /// depend on the discretisation. Many states or segments together have the weight of a few.
    std::span<const double> weights() const override { return weights_; }
    /// Does nothing if u is the point of the last evaluation, as after Newton's method.
    bool evaluate(std::span<const double> u) override;
    bool solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
               double* determinant) override;
    double round_off() const override { return equations_->round_off(at_); }
    bool has_chords() const override { return held_.empty() && equations_->has_chords(); }
    bool derivatives_are_expensive() const override { return equations_->derivatives_are_expensive(); }
    bool chord(std::span<const double> u, std::span<const double> row, std::span<double> step) override;
    /// Computes the correction at the last evaluation that another flow of the modes makes, as one of a smaller
    /// tolerance. Requires `has_chords`. @return false where it cannot follow the orbit
    bool correction_by(ModeFlow& flow, std::span<const double> row, std::span<double> step);
    void accept(std::span<const double> u) override {
        if (std::ranges::equal(u, ahead_))
            return;
        ahead_.clear();
        // Scales need not be exact, so they are renewed only every few steps.
        constexpr std::size_t renewal = 5;
        if (at_.is_at(vector_of(u)))
            for (const auto& condition : held_)
                condition->renew(*equations_, at_);
        if (accepted_++ % renewal == 0)
            equations_->set_scales(vector_of(u));
    }

    /// Does the same before the step, for which it is then not done again. @return true if the scales have changed
    bool accept_ahead(std::span<const double> u) {
        const std::vector<double> before(scales().begin(), scales().end());
        accept(u);
        ahead_.assign(u.begin(), u.end());
        return !std::ranges::equal(before, scales());
    }

    void reduce(std::span<double> difference) const override {
        const std::vector<double>& periods = at_.periods;
        for (std::size_t k = 0; k < equations_->layout().pieces(); ++k)
            for (std::size_t i = 0; i < periods.size(); ++i) {
                double& one = difference[equations_->layout().start_of(k) + i];
                one = without_turns(one, periods[i]);
            }
    }

private:
    bool evaluate_held();
    const OrbitEquations::Closed& closed_by(std::span<const double> row);
    bool correct(const Eigen::VectorXd& unknowns, std::span<const double> row, std::span<double> step, ModeFlow* flow);

    std::unique_ptr<OrbitEquations> equations_;
    OrbitEvaluation at_;
    std::vector<double> weights_;
    std::span<const std::unique_ptr<OrbitCondition>> held_;
    Eigen::MatrixXd rows_;      ///< scaled gradients of the held conditions
    Eigen::VectorXd residuals_; ///< scaled values of the held conditions
    std::vector<double> row_;   ///< row of the factored system `closed_`; empty: none
    OrbitEquations::Closed closed_;
    std::size_t accepted_ = 0;
    std::vector<double> ahead_; ///< unknowns that have been accepted before their step
};

} // namespace graze
