#include "base/signs.hpp"
#include "branch/boundary_equilibrium.hpp"
#include "branch/bounds.hpp"
#include "branch/branch_follower.hpp"
#include "branch/equilibrium_locator.hpp"
#include "graze/base/input_error.hpp"
#include "orbit/solve_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <span>

namespace graze {

namespace {

constexpr int most_changes_of_mode = 20;
constexpr int most_repetitions = 8;
constexpr double shorter_step = 0.25;

/// True when an eigenvalue cannot be told from one on the imaginary axis, given the accuracy of located points.
bool is_neutral(std::span<const std::complex<double>> eigenvalues) {
    constexpr double uncertain = 1e4; // in units of round-off
    const double margin = uncertain * neutral_growth(eigenvalues);
    return std::ranges::any_of(eigenvalues, [margin](auto one) { return std::abs(one.real()) <= margin; });
}

/// Follows a branch of equilibria, or a curve of their special points.
class EquilibriumFollower : public BranchFollower {
public:
    EquilibriumFollower(const System& system, const Orbit& candidate, const BranchSettings& settings)
        : system_(system), candidate_(candidate), settings_(settings) {
        settings_.validate(system.model());
        validate_orbit(system.model(), candidate);
        if (is_outside(settings, candidate.parameters[settings.parameter.place()]))
            throw InputError(fmt::format("the equilibrium's {} = {} lies outside the branch's bounds",
                                         system.model().independent_parameters()[settings.parameter.place()],
                                         candidate.parameters[settings.parameter.place()]),
                             "choose bounds on either side of it");
        const EquilibriumEquations equations(system, candidate.signature.front().mode, {});
        if (const std::string why = equations.why_none(candidate.parameters); !why.empty())
            throw InputError(fmt::format("there are no equilibria: {}", why), "follow orbits instead");
        make_path(candidate);
    }

    bool start() override {
        const std::vector<double> u = path_->problem()->unknowns_of(candidate_);
        return begin(continuation_->start(u, path_->problem()->parameter_place(), settings_.direction));
    }
    bool start_along(const OrbitDirection& direction, double distance) override {
        EquilibriumProblem& problem = *path_->problem();
        const std::vector<double> u = problem.unknowns_of(candidate_), along = problem.unknowns_of(direction);
        if (!problem.evaluate(u))
            return end(BranchOutcome::no_start, "the model is not defined there");
        if (distance == 0)
            return begin(continuation_->start_at(u, problem.row_of(along)));
        return begin(continuation_->start_along(u, along, distance));
    }
    bool step() override;

    const BranchPoint& point() const override { return here_.point; }

private:
    void make_path(const Orbit& orbit) {
        path_ = std::make_unique<EquilibriumPath>(system_, orbit, settings_);
        continuation_ = std::make_unique<Continuation>(path_->problem(), settings_.continuation);
        locator_ = std::make_unique<EquilibriumLocator>(*path_, *continuation_);
    }
    bool begin(bool begun);
    bool take_step(DescribedEquilibrium& before);
    void place_in_branch();
    void end_or_go_on(const DescribedEquilibrium& before);
    void finish_at(std::size_t i, BranchOutcome how, std::string why) {
        end_at(i, here_.point);
        finish(how, std::move(why));
    }
    bool goes_on_in_other_mode(SpecialPoint& special);
    bool leads_beyond() const;
    bool begins_real(const DescribedEquilibrium& before) const;

    System system_;
    Orbit candidate_;
    BranchSettings settings_;
    std::unique_ptr<EquilibriumPath> path_;
    std::unique_ptr<Continuation> continuation_;
    std::unique_ptr<EquilibriumLocator> locator_;
    DescribedEquilibrium here_;
    double arclength_ = 0; ///< of the branch where the continuation has been started anew
    int changes_of_mode_ = 0;
    std::size_t steps_ = 0;
};

bool EquilibriumFollower::begin(bool begun) {
    if (!begun)
        return end(BranchOutcome::no_start,
                   fmt::format("{} from the equilibrium that was given", name_of(continuation_->outcome())));
    auto there = path_->describe(continuation_->point());
    if (!there)
        return end(BranchOutcome::no_start, "the model is not defined there");
    here_ = std::move(*there);
    const std::string why =
        disturbed_by_clock(path_->problem()->equations(), here_.evaluation.state, here_.evaluation.parameters);
    if (!why.empty())
        return end(BranchOutcome::no_start, why);
    if (is_beyond_bounds(here_.tests))
        return end(BranchOutcome::bound, "the first equilibrium lies beyond a bound");
    ended_ = false;
    locator_->forget();
    place_in_branch();
    if (leads_beyond())
        finish(BranchOutcome::bound, "");
    return true;
}

/// True when the first point lies on a bound of a parameter and the branch leads across it.
bool EquilibriumFollower::leads_beyond() const {
    constexpr double round_off = 1e-11;
    const auto leaves = [&](std::size_t free, const std::optional<double>& least,
                            const std::optional<double>& greatest) {
        const std::size_t place = path_->problem()->parameter_place() + free;
        const double rise = here_.at.tangent[place], value = here_.at.u[place];
        const double room = round_off * std::max(std::abs(least.value_or(0)), std::abs(greatest.value_or(0)));
        return (least && rise < 0 && value <= *least + room) || (greatest && rise > 0 && value >= *greatest - room);
    };
    if (leaves(0, settings_.least, settings_.greatest))
        return true;
    for (const FreeBounds& bounds : settings_.free_bounds)
        for (std::size_t f = 0; f < settings_.free.size(); ++f)
            if (settings_.free[f] == bounds.parameter && leaves(1 + f, bounds.least, bounds.greatest))
                return true;
    return false;
}

/// True when a curve of Hopf points leads from a Bogdanov-Takens point to where the two eigenvalues are real: there
/// their sum is 0 without a Hopf bifurcation.
bool EquilibriumFollower::begins_real(const DescribedEquilibrium& before) const {
    const auto product = [](const DescribedEquilibrium& at) {
        const auto test = std::ranges::find(at.tests, PointType::takens_bogdanov, &BranchTest::type);
        return test == at.tests.end() ? 0 : test->value;
    };
    return before.at.arclength == 0 && settings_.kept->type == PointType::hopf && product(here_) < 0 &&
           std::abs(product(before)) < 1e-3 * std::abs(product(here_));
}

/// Numbers the last point within the branch.
void EquilibriumFollower::place_in_branch() {
    here_.point.arclength = arclength_ + here_.at.arclength;
    here_.point.step = steps_;
}

/// Makes a step and locates its points. A step that has jumped to another branch, or whose change of stability is not
/// explained, is repeated with a shorter one.
bool EquilibriumFollower::take_step(DescribedEquilibrium& before) {
    const Continuation start = *continuation_;
    const EquilibriumLocator locator = *locator_;
    // At a start on a bifurcation the number of unstable eigenvalues is not known.
    const bool is_plain = !settings_.kept && settings_.free.empty() &&
                          !(before.at.arclength == 0 && is_neutral(before.point.solution.eigenvalues));
    for (int attempt = 0;; ++attempt) {
        if (!continuation_->step())
            return end(continuation_->outcome() == ContinuationOutcome::undefined ? BranchOutcome::undefined
                                                                                  : BranchOutcome::no_convergence,
                       "");
        auto there = path_->describe(continuation_->point());
        if (!there)
            return end(BranchOutcome::undefined, "the model is not defined beyond");
        here_ = std::move(*there);
        found_ = locator_->locate_all(before, here_);
        const bool crossed = have_opposite_signs(before.at.determinant, here_.at.determinant);
        const bool jumped = crossed && std::ranges::none_of(found_, [](const SpecialPoint& one) {
                                return one.type == PointType::branch_point || one.type == PointType::bound;
                            });
        const bool explained = !jumped && EquilibriumLocator::explains(found_, before, here_);
        if (!is_plain || explained)
            return true;
        if (attempt == most_repetitions) {
            if (!jumped && found_.empty() && before.unstable != here_.unstable)
                if (auto several = locator_->crossing_of_several(before, here_))
                    found_.push_back(std::move(*several));
            return true;
        }
        const double length = continuation_->point().arclength - continuation_->previous().arclength;
        *continuation_ = start;
        *locator_ = locator;
        continuation_->set_next_step(shorter_step * length);
        path_->problem()->evaluate(continuation_->point().u);
    }
}

bool EquilibriumFollower::step() {
    found_.clear();
    if (ended_)
        return false;
    if (steps_ >= settings_.steps)
        return end(BranchOutcome::steps, "");
    DescribedEquilibrium before = here_;
    if (!take_step(before)) {
        here_ = std::move(before);
        return false;
    }
    if (path_->keeps(PointType::hopf) && begins_real(before)) {
        here_ = std::move(before);
        found_.clear();
        return end(BranchOutcome::stopped, "the two eigenvalues are real");
    }
    ++steps_;
    place_in_branch();
    constexpr double same_place = 1e-6; // a branch that begins at a special point must not report that point
    const double length = here_.at.arclength - before.at.arclength;
    if (before.at.arclength == 0)
        std::erase_if(found_, [&](const SpecialPoint& one) {
            return one.type != PointType::bound && one.arclength < same_place * length;
        });
    for (SpecialPoint& one : found_) {
        one.arclength += arclength_;
        one.step = steps_;
        if (one.type != PointType::branch_point && one.type != PointType::fold)
            one.solution.error = solve_equilibrium(system_, one.solution.orbit, settings_.orbit).error;
    }
    end_or_go_on(before);
    if (!ended_ && continuation_->outcome() == ContinuationOutcome::closed)
        finish(BranchOutcome::closed, "");
    return true;
}

/// Ends the branch, or changes its mode, at the special points found.
void EquilibriumFollower::end_or_go_on(const DescribedEquilibrium& before) {
    for (std::size_t i = 0; i < found_.size(); ++i) {
        const PointType type = found_[i].type;
        if (type == PointType::bound)
            return finish_at(i, BranchOutcome::bound, "");
        if (std::ranges::count(settings_.stop_at, type) > 0)
            return finish_at(i, BranchOutcome::stopped, std::string(name_of(type)));
        if (type == PointType::takens_bogdanov && path_->keeps(PointType::hopf))
            return finish_at(i, BranchOutcome::stopped, "beyond, the two eigenvalues are real");
        const bool leaves =
            type == PointType::boundary_equilibrium && !settings_.kept && settings_.stop_when_unphysical &&
            path_->model().events[found_[i].event].kind == EventKind::barrier &&
            before.point.solution.certificate.admissible && !here_.point.solution.certificate.admissible;
        if (!leaves)
            continue;
        found_.resize(i + 1);
        if (settings_.reorder && goes_on_in_other_mode(found_[i]))
            return;
        return finish_at(i, BranchOutcome::unphysical, here_.point.solution.certificate.reason);
    }
    if (settings_.stop_when_unphysical && before.point.solution.certificate.admissible &&
        !here_.point.solution.certificate.admissible)
        finish(BranchOutcome::unphysical, here_.point.solution.certificate.reason);
}

/// Continues with the equilibrium of another mode that meets this one, on its admissible side: ahead where the
/// equilibrium persists, back where two meet in a nonsmooth fold.
bool EquilibriumFollower::goes_on_in_other_mode(SpecialPoint& special) {
    if (++changes_of_mode_ > most_changes_of_mode)
        return false;
    for (const MeetingEquilibrium& other :
         meeting_equilibria(system_, special.solution.orbit, special.event, settings_)) {
        if (other.admissible == 0)
            continue;
        auto path = std::make_unique<EquilibriumPath>(system_, other.orbit, settings_);
        auto continuation = std::make_unique<Continuation>(path->problem(), settings_.continuation);
        const std::vector<double> u = path->problem()->unknowns_of(other.orbit);
        if (!continuation->start(u, path->problem()->parameter_place(), other.admissible))
            continue;
        auto there = path->describe(continuation->point());
        if (!there)
            continue;
        path_ = std::move(path);
        continuation_ = std::move(continuation);
        locator_ = std::make_unique<EquilibriumLocator>(*path_, *continuation_);
        there->point.solution.certificate = special.solution.certificate; // it lies on a surface
        here_ = std::move(*there);
        arclength_ = special.arclength;
        place_in_branch();
        special.detail +=
            fmt::format("; goes on as {}", to_string(path_->model(), here_.point.solution.orbit.signature));
        return true;
    }
    return false;
}

} // namespace

std::unique_ptr<BranchFollower> follower_of_equilibria(const System& system, const Orbit& candidate,
                                                       const BranchSettings& settings) {
    return std::make_unique<EquilibriumFollower>(system, candidate, settings);
}

} // namespace graze
