#include "base/special_numbers.hpp"
#include "branch/branch_follower.hpp"

#include "base/signs.hpp"
#include "branch/bounds.hpp"
#include "branch/chatter_end.hpp"
#include "branch/first_step.hpp"
#include "branch/homoclinic_end.hpp"
#include "branch/longest_step.hpp"
#include "branch/other_branch.hpp"
#include "branch/point_locator.hpp"
#include "branch/point_rules.hpp"
#include "branch/reordering.hpp"
#include "branch/shrinking_orbit.hpp"
#include "branch/simpler_end.hpp"
#include "branch/sliding_name.hpp"
#include "branch/test_forecast.hpp"
#include "branch/touch_curve_start.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/branch/switching.hpp"
#include "orbit/cut.hpp"
#include "orbit/eigen_index.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

/// Returns why an orbit is inadmissible; empty if it is admissible.
std::string reason_of(const BranchPoint& point) {
    return point.solution.certificate.admissible ? "" : point.solution.certificate.reason;
}

/// Follows a branch or curve of periodic orbits.
class OrbitFollower : public BranchFollower {
public:
    OrbitFollower(const System& system, const Orbit& candidate, const BranchSettings& settings)
        : state_(system, candidate, settings), candidate_(candidate), locator_(state_, here_), shrinking_(state_),
          is_kept_point_(settings.kept && settings.free.size() == (settings.kept_too ? 2U : 1U) &&
                         settings.kept->solution.orbit.parameters == candidate.parameters) {}

    bool start() override {
        constexpr double near = 1e-2; // scaled distance: a curve must begin at its kept point
        const std::vector<double> u = state_.problem().unknowns_of(candidate_);
        if (state_.is_in_family(candidate_))
            return refuse(family_in_words());
        const bool begun =
            state_.start_in_family(u) ||
            state_.continuation().start(u, state_.problem().parameter_place(), state_.settings().direction);
        // At changed parameters the orbit may no longer cross its section.
        if (!begun && !is_kept_point_ && state_.begin_without_sections(candidate_))
            return begin();
        const double off = begun && is_kept_point_ ? state_.distance_from(u) : 0;
        if (!(off < near))
            return refuse(fmt::format(
                "Newton's method leads to another orbit, {:.3g} away in units of the unknowns' sizes", off));
        return begun ? begin() : refuse("");
    }

    bool start_along(const OrbitDirection& given, double distance) override {
        OrbitProblem& problem = state_.problem();
        if (given.parameters.size() > problem.equations().free().size())
            throw InputError("the direction has more parameters than vary", "leave out those that stay");
        const std::vector<double> u = problem.unknowns_of(candidate_);
        if (!problem.evaluate(u))
            return refuse("");
        const std::vector<double> direction = problem.unknowns_of(given);
        if (distance == 0)
            return state_.continuation().start_at(u, problem.row_of(direction)) ? begin() : refuse("");
        OtherBranchSearch search(state_, candidate_, direction, distance);
        bool beyond_bounds = false;
        while (search.next()) {
            if (begin())
                return true;
            beyond_bounds = true;
        }
        return beyond_bounds ? false : refuse(search.why());
    }

    bool step() override {
        found_.clear();
        if (ended_)
            return false;
        if (here_.point.step >= state_.settings().steps)
            return end(BranchOutcome::steps, "");
        if (shrinking_.end())
            return end_at_equilibrium();
        if ((ChatterEnd::is_at_onset(here_.point.solution.orbit) && end_of_chatter()) || end_at_homoclinic())
            return true;
        if (state_.pieces_need_renewal() ||
            cuts_are_oblique(state_.problem().equations(), state_.problem().evaluation())) {
            state_.renew_pieces(here_.point);
            renewed();
        }
        const std::vector<double> rates = state_.rates_at_sections();
        if (const auto touched = touched_section(rates)) {
            if (!state_.leave_sections(here_.point))
                return end(BranchOutcome::undefined, touch_in_words(*touched));
            renewed();
        }
        const Continuation continuation = state_.continuation();
        const DescribedPoint before = here_;
        const std::size_t work = state_.problem().equations().work();
        if (!shrinking_.step([&] { return step_before_simpler(); }, here_.point, rates))
            return continue_beyond_edge();
        if (reversed_section(rates, state_.rates_at_sections()) || shrinking_.must_turn())
            return step_without_touch(continuation);
        shrinking_.update(before.point.solution.orbit);
        chatter_end_.note(before.point);
        describe_here();
        ++here_.point.step;
        here_.point.iterations = state_.continuation().point().iterations;
        return finish_step(continuation, before, state_.problem().equations().work() - work);
    }

    const BranchPoint& point() const override { return here_.point; }

private:
    /// Largest number of repetitions of a step, and of changes of the signature.
    static constexpr int most_attempts = 8, most_reorderings = 100;
    /// Factor of the length of a repeated step.
    static constexpr double shorter = 0.25, half = 0.5;

    /// Checks and completes a step that has been made. @param before its start; @param work of its last point
    bool finish_step(const Continuation& continuation, const DescribedPoint& before, std::size_t work) {
        if (const auto wrong = wrong_side(state_.settings(), before, here_)) {
            here_ = before;
            return end(wrong->first, wrong->second);
        }
        if (shrinking_.end() && here_.point.arclength > shrinking_.end()->arclength) {
            here_ = before;
            return end_at_equilibrium();
        }
        if (!is_as_expected() && attempts_ < most_attempts)
            return step_shorter(continuation, before, half);
        found_ = locator_.locate_all(before);
        if (has_jumped() && attempts_ < most_attempts)
            return step_again(continuation, before);
        if (!returned_)
            locator_.add_missed(found_, before);
        if (locator_.misses_bound(found_, before)) {
            if (attempts_ < most_attempts)
                return step_again(continuation, before);
            found_.clear();
            here_ = before;
            return end(BranchOutcome::bound, "no orbit was found on the bound itself");
        }
        attempts_ = 0;
        choose_next_step();
        if (state_.settings().kept)
            simpler_end_.note(state_);
        drop_points_at_start(here_.point.arclength - before.point.arclength);
        end_or_reorder(before.point.solution.certificate.admissible);
        if (!ended_ && returned_)
            finish(BranchOutcome::returned, returned_to_simpler);
        if (!ended_ && state_.continuation().outcome() == ContinuationOutcome::closed)
            finish(BranchOutcome::closed, "");
        if (!ended_ && work > state_.settings().work)
            finish(BranchOutcome::too_long,
                   fmt::format("the last point took {} steps of integration, at period {:.6g}: bounds of what varies "
                               "would end it before",
                               work, here_.point.solution.orbit.period()));
        return true;
    }
    /// Ends a curve at the simpler orbits that it has all but met.
    bool end_beside_simpler() {
        ContinuationPoint at = state_.continuation().point();
        at.u = state_.problem().unknowns_of(simpler_end_.estimate(state_.orbit()));
        const auto there = state_.describe(at);
        found_ = {special_of_type(PointType::branch_point, there ? there->point : here_.point)};
        found_[0].detail = returned_to_simpler;
        found_[0].located = false; // it is extrapolated
        found_[0].bracket = std::minmax(here_.point.parameter, found_[0].parameter);
        found_[0].step = ++here_.point.step;
        finish_at(0, BranchOutcome::returned, returned_to_simpler);
        return true;
    }
    /// After a step that failed: continues a curve of touches where the touch has come to the edge of its segment.
    bool continue_beyond_edge() {
        if (state_.settings().kept && !starts_simpler_ && simpler_end_.is_beside())
            return end_beside_simpler();
        const std::string edge = touch_at_edge(state_.settings(), here_.point.solution.orbit);
        if (edge.empty() && end_of_chatter())
            return true;
        if (edge.empty())
            return end(state_.continuation().outcome() == ContinuationOutcome::undefined
                           ? BranchOutcome::undefined
                           : BranchOutcome::no_convergence,
                       state_.problem().problem());
        auto beyond = ++reorderings_ <= most_reorderings ? continue_in_next_segment(state_, here_.point) : std::nullopt;
        if (!beyond)
            return end(BranchOutcome::undefined, edge);
        beyond->point.step = here_.point.step + 1;
        here_ = std::move(*beyond);
        locator_.forget();
        restart_forecast();
        return true;
    }
    /// Ends the branch where a chatter sequence or the rest after it vanishes. @return false if none does
    bool end_of_chatter() {
        chatter_end_.note(here_.point);
        auto point = chatter_end_.find(state_);
        if (!point)
            return false;
        found_ = {*point};
        found_[0].step = ++here_.point.step;
        finish_at(0, BranchOutcome::unphysical,
                  point->type == PointType::chatter     ? "contacts no longer accumulate"
                  : point->type == PointType::vanishing ? "the motion stays at rest"
                                                        : "a contact has no speed");
        return true;
    }
    /// Ends the branch in the equilibrium to which its orbits shrink.
    bool end_at_equilibrium() {
        found_ = {*shrinking_.end()};
        found_[0].bracket = std::minmax(here_.point.parameter, found_[0].parameter);
        found_[0].step = ++here_.point.step;
        finish_at(0, BranchOutcome::shrunk, "");
        return true;
    }
    /// Ends the branch in the homoclinic orbit that its orbits approach. @return false if they approach none
    bool end_at_homoclinic() {
        if (!HomoclinicEnd::is_sought(state_.settings(), here_.point) ||
            !state_.problem().evaluate(state_.continuation().point().u))
            return false;
        auto point = homoclinic_end_.find(state_, here_.point);
        if (!point)
            return false;
        found_ = {std::move(*point)};
        found_[0].step = ++here_.point.step;
        finish_at(0, BranchOutcome::homoclinic, "");
        return true;
    }
    /// Makes a step. If it ends on a branch of simpler orbits (half the period, or symmetric), it has passed the
    /// crossing with that branch and is repeated with a shorter step.
    bool step_before_simpler() {
        Continuation& continuation = state_.continuation();
        const Continuation before = continuation;
        for (int attempt = 0;; ++attempt) {
            if (!continuation.step())
                return false;
            returned_ = !starts_simpler_ && is_degenerate(state_, state_.orbit(), same_orbit);
            if (!returned_ || attempt >= most_attempts)
                return true;
            restore(before);
        }
    }
    /// Resets what depends on the equations, after they were replaced.
    void renewed() {
        locator_.forget();
        describe_here();
        restart_forecast();
    }
    /// Forgets the tests of the points before, which are not those of the points that follow.
    void restart_forecast() {
        forecast_.forget();
        choose_next_step();
    }
    /// Shortens the next step where it is longer than usual and the tests may come near zero in it.
    void choose_next_step() {
        constexpr double usual = ContinuationOptions().largest_step;
        Continuation& continuation = state_.continuation();
        forecast_.add(here_.point.arclength, here_.tests);
        if (state_.settings().kept) // the tests of curves are in units that follow those of the equations later
            return;
        usual_ = longest_step(state_.problem(), continuation.previous(), continuation.point(),
                              std::min(usual, state_.settings().continuation.largest_step));
        // A step that the forecast has shortened says nothing against longer ones.
        constexpr double growth = 2;
        const double wanted = std::max(continuation.next_step(), std::min(wanted_, growth * state_.last_step().length));
        wanted_ = 0;
        if (!(wanted > usual_))
            return;
        renew_units();
        const double length = forecast_.length(usual_, wanted);
        if (length < wanted)
            wanted_ = wanted;
        if (length != continuation.next_step())
            continuation.set_next_step(length);
    }
    /// True when a step is longer than usual.
    bool is_long(double length) const {
        constexpr double round_off = 1e-9;
        return length > (1 + round_off) * usual_;
    }
    /// Lets the equations choose the units of the next step, and tells the forecast the tests in these.
    void renew_units() {
        OrbitProblem& problem = state_.problem();
        ContinuationPoint here = state_.continuation().point();
        if (!problem.accept_ahead(here.u))
            return;
        const double length = problem.length_of(here.tangent);
        entries_of(here.tangent) /= length;
        std::vector<double> step(here.u.size());
        const auto there =
            problem.evaluate(here.u) && problem.solve(problem.row_of(here.tangent), 1, true, step, &here.determinant)
                ? state_.describe(here)
                : std::nullopt;
        if (there)
            forecast_.rescale(length, there->tests);
        else
            forecast_.forget();
    }
    /// True when the last step is not longer than usual, or the branch and its tests are as smooth as that requires:
    /// the tests as predicted, and the step along the mean of the tangents at its ends.
    bool is_as_expected() {
        constexpr double off = 0.02; // share of the length
        const ContinuationPoint &from = state_.continuation().previous(), &to = state_.continuation().point();
        const double length = to.arclength - from.arclength;
        if (!is_long(length))
            return true;
        const std::vector<double> apart = numbers_of(vector_of(to.u) - vector_of(from.u) -
                                                     0.5 * length * (vector_of(from.tangent) + vector_of(to.tangent)));
        return state_.problem().length_of(apart) < off * length &&
               forecast_.foresees(here_.point.arclength, here_.tests);
    }
    /// Returns to the start of the last step, for a shorter one.
    void restore(const Continuation& before, double factor = shorter) {
        Continuation& continuation = state_.continuation();
        const double length = continuation.point().arclength - continuation.previous().arclength;
        continuation = before;
        wanted_ = is_long(length) ? continuation.next_step() : 0;
        continuation.set_next_step(is_long(length) ? std::max(factor * length, usual_) : factor * length);
    }
    /// Repeats the last step: towards an equilibrium to which the orbits shrink, without the section that was touched
    /// within the step, or with a shorter step if the section is needed or a cut was touched.
    bool step_without_touch(const Continuation& before) {
        const double length = state_.continuation().point().arclength - state_.continuation().previous().arclength;
        state_.continuation() = before;
        state_.problem().evaluate(state_.continuation().point().u);
        if (shrinking_.turn(here_.point) || state_.leave_sections(here_.point))
            renewed();
        else if (shorter * length > state_.settings().continuation.smallest_step)
            state_.continuation().set_next_step(shorter * length);
        else
            return end(BranchOutcome::no_convergence, "the orbit is tangent to the plane of its cut");
        return step();
    }
    /// True when the last step has jumped to a nearby branch that does not cross this one: the determinant has changed
    /// its sign, but no branch point or limit point was found.
    bool has_jumped() {
        const Continuation& continuation = state_.continuation();
        return !state_.settings().kept && !returned_ &&
               have_opposite_signs(continuation.previous().determinant, continuation.point().determinant) &&
               std::none_of(found_.begin(), found_.end(), [](const SpecialPoint& one) {
                   return one.type == PointType::branch_point || kind_of(one.type).limits;
               });
    }
    /// Repeats the last step with a shorter one, as where it has jumped or passed a bound that could not be located.
    bool step_again(const Continuation& continuation, const DescribedPoint& before) {
        found_.clear();
        locator_.forget();
        return step_shorter(continuation, before);
    }
    /// The same before anything was located within it.
    bool step_shorter(const Continuation& continuation, const DescribedPoint& before, double factor = shorter) {
        ++attempts_;
        here_ = before;
        restore(continuation, factor);
        state_.problem().evaluate(state_.continuation().point().u);
        return step();
    }
    /// Returns the message for a candidate in a family of orbits, for which no branch is defined.
    std::string family_in_words() const {
        const Model& model = state_.model();
        return fmt::format("the orbit is one of a family at the same '{}' (a multiplier is 1: something is conserved). "
                           "Declare what it is, as in [conserved] energy = \"...\" of the model: it is then held. Or "
                           "follow the family "
                           "itself: along = \"period\"",
                           model.independent_parameters()[state_.settings().parameter.place()]);
    }
    std::string touch_in_words(std::size_t segment) const {
        return fmt::format("the orbit only touches the section '{}', at which monitors are taken or a touch is kept: "
                           "choose another section, or monitors along the whole orbit",
                           end_name(state_.model(), here_.point.solution.orbit.signature[segment]));
    }

    void describe_here() {
        if (auto described = state_.describe(state_.continuation().point())) {
            described->point.step = here_.point.step;
            described->point.iterations = here_.point.iterations;
            here_ = std::move(*described);
        }
        if (!is_beyond_bounds(here_.tests)) {
            put_on_bounds(state_.settings(), here_.point.solution.orbit);
            here_.point.parameter = here_.point.solution.orbit.parameters[state_.settings().parameter.place()];
        }
    }

    /// Ends the branch before its first point. @param why empty: as the equations or the continuation say
    bool refuse(std::string why) {
        if (why.empty())
            why = state_.problem().problem();
        if (why.empty())
            why = fmt::format("{} from the orbit that was given", name_of(state_.continuation().outcome()));
        return end(BranchOutcome::no_start, std::move(why));
    }
    /// Describes the first point. @return false where it lies beyond a bound
    bool begin() {
        ended_ = false;
        here_ = {};
        describe_here();
        if (is_beyond_bounds(here_.tests))
            return end(BranchOutcome::bound, "at the first orbit " + beyond_in_words(state_, here_.point));
        starts_simpler_ = is_degenerate(state_, state_.orbit(), same_orbit);
        restart_forecast();
        if (leads_beyond_bounds(state_))
            finish(BranchOutcome::bound, "");
        return true;
    }
    /// Continues with orbits of another signature beyond a point. @return false when none are found
    bool continue_reordered(SpecialPoint& special) {
        if (++reorderings_ > most_reorderings)
            return false;
        try {
            if (!state_.settings().kept)
                state_.continue_on(branches_at(state_.system(), special, state_.settings()).front(), special.arclength);
            else if (!continue_reordered_curve(state_, special))
                return false;
        } catch (const InputError& error) { // no orbit beyond: the branch ends
            special.detail += fmt::format("; {}", error.problem());
            return false;
        }
        special.detail +=
            fmt::format("; goes on as {}", to_string(state_.model(), state_.problem().equations().signature()));
        renewed();
        starts_simpler_ = is_degenerate(state_, state_.orbit(), same_orbit);
        return true;
    }

    /// Removes points found at the start of a branch: a branch that begins at a special point of another must not
    /// report that point.
    void drop_points_at_start(double length) {
        constexpr double same_place = 1e-6;
        if (here_.point.step == 1)
            std::erase_if(found_, [&](const SpecialPoint& special) {
                return special.type != PointType::bound && special.arclength < same_place * length;
            });
    }

    /// True when a curve of torus points ends, since the pair becomes real there.
    bool ends_torus_curve(const SpecialPoint& special) const {
        return state_.settings().kept && state_.settings().kept->type == PointType::torus &&
               (special.type == PointType::resonance_1 || special.type == PointType::resonance_2);
    }

    void finish_at(std::size_t i, BranchOutcome how, std::string why) {
        end_at(i, here_.point);
        finish(how, std::move(why));
    }
    /// Returns why orbits beyond special point i are inadmissible; empty if they are admissible. Admissibility is
    /// tested at the end of the step or, if another limit point follows, half-way to it, because the second may undo
    /// the effect of the first.
    std::string unphysical_beyond(std::size_t i) {
        constexpr double apart = 1e-6; // fraction of the step
        const LastStep step = state_.last_step();
        const double at = step.fraction(found_[i].arclength);
        for (std::size_t j = i + 1; j < found_.size() && !state_.settings().kept; ++j) {
            const double next = step.fraction(found_[j].arclength);
            if (rank(found_[j]) < 0 || next - at < apart)
                continue;
            const auto there = state_.describe_between(0.5 * (at + next));
            state_.problem().evaluate(state_.continuation().point().u);
            if (!there)
                break;
            return reason_of(there->point);
        }
        return reason_of(here_.point);
    }
    /// Ends the branch or changes its signature at the special points found.
    void end_or_reorder(bool was_admissible) {
        for (std::size_t i = 0; i < found_.size(); ++i) {
            const PointType type = found_[i].type;
            if (type == PointType::bound)
                return finish_at(i, BranchOutcome::bound, "");
            if (is_degenerate(state_, found_[i])) {
                found_[i].detail = returned_to_simpler;
                return finish_at(i, BranchOutcome::returned, returned_to_simpler);
            }
            if (ends_torus_curve(found_[i]))
                return finish_at(i, BranchOutcome::stopped, "beyond, the two multipliers are real");
            if (std::ranges::count(state_.settings().stop_at, type) > 0)
                return finish_at(i, BranchOutcome::stopped, std::string(name_of(type)));
            const bool may_end = state_.settings().stop_when_unphysical && was_admissible && rank(found_[i]) >= 0;
            const std::string reason = may_end ? unphysical_beyond(i) : "";
            if (reason.empty())
                continue;
            end_at(i, here_.point);
            // With another signature, a kept point that belongs to a segment is only found again if it is a touch.
            const auto& kept = state_.settings().kept;
            const bool begins_other = is_grazing(type) && !is_adding_sliding(state_.system(), found_[i]);
            const bool reordering = state_.settings().reorder && !begins_other &&
                                    (!kept || !kind_of(kept->type).limits || keeps_touch(state_.settings()));
            if (!reordering || !continue_reordered(found_[i]))
                return finish_at(i, BranchOutcome::unphysical, reason); // without the attempts beyond
            if (is_beyond_bounds(here_.tests))                          // a bound lies just beyond the point
                finish_at(i, BranchOutcome::bound, "");
            return;
        }
        if (state_.settings().stop_when_unphysical && was_admissible && !here_.point.solution.certificate.admissible &&
            !end_of_chatter())
            finish(BranchOutcome::unphysical, here_.point.solution.certificate.reason);
    }

    DescribedPoint here_; ///< the last point
    BranchState state_;
    Orbit candidate_;
    PointLocator locator_;
    ShrinkingOrbit shrinking_;
    int reorderings_ = 0;
    bool is_kept_point_;          ///< a curve begins at its kept point, not at changed parameters
    bool returned_ = false;       ///< the last step has led to simpler orbits
    bool starts_simpler_ = false; ///< the first orbit is a repeated orbit, or symmetric but not given as a half orbit
    SimplerEnd simpler_end_;
    ChatterEnd chatter_end_;
    HomoclinicEnd homoclinic_end_;
    int attempts_ = 0; ///< number of repetitions of the current step
    TestForecast forecast_;
    /// Length of the next step that is made whatever the tests may be.
    double usual_ = infinity;
    /// Length of the next step if the tests had not shortened the last one; 0: they have not.
    double wanted_ = 0;
};

} // namespace

std::unique_ptr<BranchFollower> follower_of_orbits(const System& system, const Orbit& candidate,
                                                   const BranchSettings& settings) {
    return std::make_unique<OrbitFollower>(system, candidate, settings);
}

} // namespace graze
