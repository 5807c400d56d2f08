#pragma once

#include "branch/equilibrium_conditions.hpp"
#include "branch/equilibrium_monitors.hpp"
#include "branch/equilibrium_normal_form.hpp"
#include "branch/point_kind.hpp"
#include "graze/branch/continuation.hpp"

#include <complex>
#include <memory>
#include <optional>
#include <vector>

namespace graze {

/// A point of a branch or curve of equilibria with its test functions, always in the same order.
struct DescribedEquilibrium {
    ContinuationPoint at;
    EquilibriumEvaluation evaluation;
    BranchPoint point;
    std::vector<BranchTest> tests;
    std::size_t unstable = 0; ///< eigenvalues in the right half plane
};

/// What belongs to a branch of equilibria in one mode: its equations, the conditions that it holds, monitors.
class EquilibriumPath {
public:
    /// @throws InputError when candidate or settings do not fit the model
    EquilibriumPath(const System& system, const Orbit& candidate, const BranchSettings& settings);

    const std::shared_ptr<EquilibriumProblem>& problem() const { return problem_; }
    const BranchSettings& settings() const { return settings_; }
    const System& system() const { return problem_->equations().system(); }
    const Model& model() const { return system().model(); }
    bool keeps(PointType type) const { return settings_.kept && settings_.kept->type == type; }
    /// Describes a point with its tests; empty where the equations are not defined.
    std::optional<DescribedEquilibrium> describe(const ContinuationPoint& at) const;
    /// The normal form at a Hopf point with this product of the pair; empty where it does not exist.
    std::optional<HopfForm> form_at(const EquilibriumEvaluation& at, double product) const;

private:
    void hold(const EquilibriumEvaluation& at);
    template <class Condition>
    const Condition* keep(std::unique_ptr<Condition> condition) {
        const Condition* const kept = condition.get();
        problem_->hold(std::move(condition));
        return kept;
    }
    void add_tests(DescribedEquilibrium& there) const;
    void add_tests_of_kept(DescribedEquilibrium& there) const;
    void add_events(DescribedEquilibrium& there) const;
    void add_extrema(DescribedEquilibrium& there) const;
    void add_crossings(DescribedEquilibrium& there) const;

    BranchSettings settings_;
    std::shared_ptr<EquilibriumProblem> problem_;
    EquilibriumMonitors monitors_;
    // Of a curve of folds or of Hopf points: its condition, which the problem owns and keeps up to date.
    const EquilibriumFold* fold_ = nullptr;
    const EquilibriumHopf* hopf_ = nullptr;
    std::shared_ptr<const EquilibriumThirdDerivatives> third_; ///< of a curve of Hopf points
};

/// Returns the eigenvalues without the two whose sum is nearest to zero and whose product is nearest to the given one.
std::vector<std::complex<double>> without_pair(std::vector<std::complex<double>> eigenvalues, double product);
/// Returns the real part of the complex pair that is nearest to the imaginary axis; NaN if there is none.
double growth_of_nearest_pair(const std::vector<std::complex<double>>& eigenvalues);
/// Returns the product of the pair of a Hopf point: that of the complex pair nearest to the imaginary axis.
double product_of_nearest_pair(const std::vector<std::complex<double>>& eigenvalues);

} // namespace graze
