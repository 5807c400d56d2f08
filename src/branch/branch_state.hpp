#pragma once

#include "branch/orbit_problem.hpp"
#include "branch/point_kind.hpp"
#include "graze/branch/orbit_branch.hpp"
#include "graze/branch/switching.hpp"
#include "orbit/certify.hpp"
#include "orbit/cut.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace graze {

/// A step of the continuation, in arclength on the branch.
struct LastStep {
    double from = 0, length = 0;
    double fraction(double arclength) const { return (arclength - from) / length; }
};

/// What a point that is found on a branch has from there; what it is besides is its type's.
SpecialPoint special_of_type(PointType type, const BranchPoint& there);

/// The equations that a branch follows, where on it the continuation is, and what can be said of its points.
class BranchState {
public:
    /// @throws InputError when candidate or settings do not fit the model
    BranchState(const System& system, const Orbit& candidate, const BranchSettings& settings);

    const System& system() const { return simulation_.system(); }
    const Model& model() const { return system().model(); }
    const BranchSettings& settings() const { return settings_; }
    OrbitProblem& problem() { return *problem_; }
    Continuation& continuation() { return *continuation_; }
    /// Arclength on the branch of one in the present continuation, which may not have begun where the branch did.
    double arclength(double in_continuation) const { return arclength_ + in_continuation; }
    LastStep last_step() const;
    /// How an orbit moves where a segment of it begins.
    std::vector<double> rates_at(const Orbit& orbit, std::size_t segment) const;
    bool is_outside(double parameter) const;

    /// What is known of a point of the branch. @return false where its equations are not defined
    bool describe(const ContinuationPoint& at, BranchPoint& result, std::vector<BranchTest>& tests);
    /// By how much an orbit of the branch would change at a tolerance a hundred times smaller, relative to the size of
    /// each unknown. None where that cannot be said: where another branch crosses, or monitors are held.
    std::optional<double> error_of(const Orbit& orbit, const OrbitDirection& tangent);
    /// Whether derivatives have grown too much for their pieces, or the last piece of a segment, which alone has a
    /// duration that is free, has become too short for the others.
    bool pieces_are_unfit();
    /// Whether an orbit is one of many at the same parameters, which the branch's own parameter leaves as many.
    bool is_in_family(const Orbit& orbit);
    /// Splits the segments anew and goes on from a point, or lays its cuts anew.
    void renew_pieces(const BranchPoint& from);
    /// Goes on from a point with equations that have no sections. @return false, and nothing is changed, where these
    /// are needed: something is said of where they are passed
    bool leave_sections(const BranchPoint& from);
    /// Goes on from a point with another description of its orbit. @return false, and nothing is changed, where the
    /// equations do not start there, or something is said of where sections are passed
    bool begin_anew(const BranchPoint& from, const UncutOrbit& same);
    /// The same before the branch has begun, which is done anew. @return false where the orbit has no sections, either
    bool begin_without_sections(const Orbit& candidate);
    /// Goes on along other equations. @throws InputError when that is impossible
    void go_on(const BranchStart& start, double arclength);
    /// Goes on along a curve from a guess of another signature. @param direction of the parameter
    /// @return false when Newton's method does not lead to an orbit of the curve: then there is nowhere to go on from
    bool go_on_curve(const Orbit& guess, int direction, double arclength);
    /// From now on the touch that is kept is one of the image of its event: where a half orbit ends its image goes on.
    /// @return false where nothing is done at the event, so that it has no image that is known
    bool keep_image_of_touch(const Orbit& orbit);

private:
    void hold(const Orbit& candidate);
    void hold_monitors();
    bool keeps_branch_point() const { return settings_.kept && settings_.kept->type == PointType::branch_point; }
    bool hold_kept(const Orbit& orbit);
    std::size_t held_monitors() const;
    std::optional<HeldLimit> held_limit() const;
    void note_kept(const OrbitSolution& solution);
    bool find_touch(const Orbit& orbit);
    bool needs_sections(const Orbit& orbit, const Orbit& without) const;
    OrbitDirection across_cuts(const Orbit& orbit, OrbitDirection direction) const;
    bool restart(const Orbit& orbit, const OrbitDirection& direction, double arclength);
    bool make_problem(const Orbit& orbit);

    BranchSettings settings_;
    Simulation simulation_;
    std::optional<Simulation> tighter_; ///< once it has been asked for
    std::unique_ptr<OrbitMonitors> monitors_;
    std::vector<std::unique_ptr<OrbitCondition>> held_; ///< one for each free parameter, those of the kept point last
    std::shared_ptr<OrbitProblem> problem_;
    std::unique_ptr<Continuation> continuation_;
    double arclength_ = 0, growth_ = 1;
};

} // namespace graze
