#pragma once

#include "branch/orbit_problem.hpp"
#include "branch/orbit_quantity.hpp"
#include "branch/point_kind.hpp"
#include "graze/branch/orbit_branch.hpp"
#include "graze/branch/switching.hpp"
#include "orbit/certify.hpp"
#include "orbit/cut.hpp"
#include "orbit/second_variation.hpp"

#include <Eigen/Core>

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// A point of the branch with all its test functions.
struct DescribedPoint {
    BranchPoint point;
    std::vector<BranchTest> tests;
};

/// The last step of the continuation, in arclength of the branch.
struct LastStep {
    double from = 0, length = 0;
    double fraction(double arclength) const { return (arclength - from) / length; }
};

/// Returns a special point with the data of a branch point; the caller sets what depends on its type.
SpecialPoint special_of_type(PointType type, const BranchPoint& there);

/// The state of a branch: its equations, the position of the continuation, and the description of its points.
class BranchState {
public:
    /// @throws InputError when candidate or settings do not fit the model
    BranchState(const System& system, const Orbit& candidate, const BranchSettings& settings);

    const System& system() const { return simulation_.system(); }
    const Model& model() const { return system().model(); }
    const BranchSettings& settings() const { return settings_; }
    OrbitProblem& problem() { return *problem_; }
    /// Second derivatives of the equations, which do not depend on the signature; made when first needed.
    SecondVariation& second_variation();
    Continuation& continuation() { return *continuation_; }
    /// Converts an arclength of the current continuation, which may have been restarted, to one of the branch.
    double arclength(double in_continuation) const { return arclength_ + in_continuation; }
    LastStep last_step() const;
    /// Returns the orbit at the current point.
    Orbit orbit() const { return problem_->orbit_of(continuation_->point().u); }
    /// Returns the distance of unknowns from the current point, in units of their scales.
    double distance_from(std::span<const double> u) const;
    /// Returns the rates at which the current orbit crosses its sections.
    std::vector<double> rates_at_sections();
    /// Returns the vector field at the start of a segment.
    std::vector<double> rates_at(const Orbit& orbit, std::size_t segment) const;

    /// Describes a point of the branch; empty where its equations are not defined.
    /// @param only the type of the only test that is needed: costly tests of other types are then NaN
    std::optional<DescribedPoint> describe(const ContinuationPoint& at, std::optional<PointType> only = std::nullopt);
    /// The same at a fraction of the last step; empty also where Newton's method does not converge.
    /// @param known solutions within the step, as of Continuation::between, to which this one is added
    std::optional<DescribedPoint> describe_between(double fraction, std::optional<PointType> only = std::nullopt,
                                                   std::vector<ContinuationPoint>* known = nullptr);
    /// Returns the change of an orbit of the branch at a hundredth of the tolerance, relative to the scale of each
    /// unknown. Empty where it is not defined: at branch points, or with additional free parameters.
    std::optional<double> error_of(const Orbit& orbit, const OrbitDirection& tangent);
    /// True when derivatives have grown too much within a piece, or the last piece of a segment, the only one of
    /// variable duration, has become too short.
    bool pieces_need_renewal();
    /// Starts along a family, in the direction in which its coordinate changes. @return false where the branch is no
    /// family, or the coordinate has an extremum
    bool start_in_family(std::span<const double> u);
    /// Returns the row whose product with a direction is the change of the family's coordinate or, if `conserved`, of
    /// what is conserved; empty if the branch is no family, or nothing is declared.
    std::optional<Eigen::RowVectorXd> rise_of_family(bool conserved);
    /// True when an orbit belongs to a family at the same parameters.
    bool is_in_family(const Orbit& orbit);
    /// Continues from a point with newly split segments and newly laid cuts.
    void renew_pieces(const BranchPoint& from);
    /// Continues from a point with equations without sections. @return false, with nothing changed, where monitors or
    /// the kept point need the sections
    bool leave_sections(const BranchPoint& from);
    /// Continues from a point with another representation of its orbit. @return false, with nothing changed, where the
    /// continuation does not start or the sections are needed
    bool replace_orbit(const BranchPoint& from, const UncutOrbit& same) {
        return replace_orbit(from, same, Guess::solution);
    }
    /// The same before the start of the branch. @return false also where the orbit has no sections
    bool begin_without_sections(const Orbit& candidate);
    /// Continues along another branch or signature. @throws InputError when the continuation does not start there
    void continue_on(const BranchStart& start, double arclength);
    /// Continues a curve from a guess of another signature. @param direction of the parameter
    /// @return false when Newton's method does not converge to an orbit of the curve; the state is then unusable
    bool continue_curve(const Orbit& guess, int direction, double arclength);
    /// Replaces the event of the kept touch by its image, because the image of a half orbit follows its end.
    /// @return false where the event has no transition or no image
    bool keep_image_of_touch(const Orbit& orbit);

private:
    bool is_family() const { return settings_.family && settings_.unfolded > 0 && !settings_.kept; }
    void hold_monitors();
    bool keeps_branch_point() const { return settings_.kept && settings_.kept->type == PointType::branch_point; }
    bool hold_kept(const Orbit& orbit);
    void hold_neutral_directions();
    std::size_t kept_conditions() const;
    void update_kept_time(const OrbitSolution& solution);
    bool find_touch(const Orbit& orbit);
    bool needs_sections(const Orbit& orbit, const Orbit& without) const;
    OrbitDirection across_cuts(const Orbit& orbit, OrbitDirection direction) const;
    enum class Guess { solution, inexact };
    bool replace_orbit(const BranchPoint& from, const UncutOrbit& same, Guess guess);
    bool restart(const Orbit& orbit, const OrbitDirection& direction, double arclength, Guess guess = Guess::solution);
    bool correct(std::vector<double>& u, const OrbitDirection& direction);
    bool make_problem(const Orbit& orbit);
    bool distances_need_renewal() const;
    bool turns_need_renewal() const;
    bool renewal_was_tried() const;
    bool renew_turns(const BranchPoint& from);

    BranchSettings settings_;
    Simulation simulation_;
    std::optional<Simulation> tighter_; ///< made when first needed
    std::optional<ModeFlow> tighter_flow_;
    std::optional<SecondVariation> second_variation_;
    std::unique_ptr<OrbitMonitors> monitors_;
    /// One condition for each additional free parameter, those of the kept point last.
    std::vector<std::unique_ptr<OrbitCondition>> held_;
    std::shared_ptr<OrbitProblem> problem_;
    std::unique_ptr<Continuation> continuation_;
    /// Along families: changes of the coordinate, and of what is conserved; made when first needed.
    std::array<std::optional<OrbitQuantity>, 2> rises_;
    double arclength_ = 0, growth_ = 1;
    /// Arclength at which a homoclinic orbit could not begin and end at other distances last.
    double not_renewed_at_ = -std::numeric_limits<double>::infinity();
};

} // namespace graze
