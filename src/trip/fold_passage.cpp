#include "graze/trip/fold_passage.hpp"

#include "branch/normal_form.hpp"
#include "flow/cyclic.hpp"
#include "graze/base/input_error.hpp"
#include "graze/branch/curve_start.hpp"
#include "orbit/shooting.hpp"
#include "trip/end_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace graze {

namespace {

constexpr double pi = std::numbers::pi;

/// The gate is the w at which an orbit would have the multiplier 1 - 2 share: near enough for the normal form, and
/// outside the region of slow passage.
constexpr double gate_share = 0.05;

SpecialPoint as_fold(const SpecialPoint& point) {
    if (point.type == PointType::fold)
        return point;
    const std::vector<PointType> known = curves_at(point);
    if (point.type == PointType::branch_point || std::ranges::find(known, PointType::fold) == known.end())
        throw InputError(fmt::format("a point of type {} ({}) is no fold", short_name(point.type), name_of(point.type)),
                         "choose a fold (SN), or a point of a curve of folds");
    return as_type(point, PointType::fold);
}

/// Records w at each return to the section on which the first segment of the orbit starts.
class ReturnWatch : public EndWatch {
public:
    ReturnWatch(const System& system, const FoldPassage& fold, const TripEnd& end, bool until_passed,
                const TripOptions& options, double start)
        : EndWatch(end, {}, options.interrupted), fold_(fold), until_passed_(until_passed),
          closing_(fold.orbit.signature.back()), w_(start), periods_(system.periods()(fold.orbit.parameters)) {
        each_ = static_cast<std::size_t>(std::ranges::count(fold.orbit.signature, closing_));
    }

    void contact(const Contact& contact) override {
        EndWatch::contact(contact);
        if (closing_.end == SegmentEnd::event && contact.transition == closing_.index &&
            contact.kind == ContactKind::crossing)
            record_return(contact.time, contact.after);
    }
    void passage(const Passage& passage) override {
        EndWatch::passage(passage);
        if (passage.probe == 1 && passage.mode == closing_.mode)
            record_return(passage.time, passage.state);
    }
    bool stop() override { return EndWatch::stop() || (until_passed_ && passed_); }

    bool passed() const { return passed_; }
    double cycles() const { return cycles_; }
    double time() const { return time_; }

private:
    void record_return(double time, std::span<const double> state) {
        if (passed_ || ++passages_ % each_ != 0)
            return;
        ++returns_;
        double w = 0;
        for (std::size_t i = 0; i < state.size(); ++i) {
            const double difference = state[i] - fold_.orbit.starts.front()[i];
            w += fold_.adjoint[i] * (periods_[i] > 0 ? without_turns(difference, periods_[i]) : difference);
        }
        if (w >= fold_.gate) {
            const double part = (fold_.gate - w_) / (w - w_);
            passed_ = true;
            cycles_ = returns_ - 1 + part;
            time_ = last_ + part * (time - last_);
        }
        w_ = w;
        last_ = time;
    }

    const FoldPassage& fold_;
    bool until_passed_, passed_ = false;
    Segment closing_;
    std::size_t each_ = 1, passages_ = 0;
    double w_, last_ = 0, returns_ = 0, cycles_ = 0, time_ = 0;
    std::vector<double> periods_;
};

/// True when no multiplier lies outside the unit circle.
bool is_attracting(const OrbitSolution& solution) {
    constexpr double beside = 1e-4; // the critical multiplier is known to the square root of the orbit's accuracy
    return std::ranges::none_of(solution.multipliers,
                                [](std::complex<double> one) { return std::abs(one) > 1 + beside; });
}

/// Returns the gate; near a cusp it is limited by the cubic term c w^3.
double gate_of(const OrbitEquations& equations, const OrbitEvaluation& at, const FoldForm& form,
               SecondVariation& variation) {
    constexpr double cubic_share = 0.3, no_size = 1e-6;
    const double gate = gate_share / form.coefficient;
    double size = 0; // scaled size of the critical vector, the step of third derivatives
    for (std::size_t i = 0; i < form.critical.size(); ++i)
        size = std::max(size, std::abs(form.critical[i]) * at.scales[static_cast<Eigen::Index>(i)]);
    if (size < no_size * gate)
        return gate; // an orbit at zero has no extent
    const auto cubic = cusp_coefficient(equations, at, variation);
    return cubic && *cubic != 0 ? std::min(gate, cubic_share * form.coefficient / std::abs(*cubic)) : gate;
}

} // namespace

double FoldPassage::root(double overshoot) const {
    return std::sqrt(std::abs(coefficient * rate * overshoot));
}

FoldPassage fold_passage(const System& system, const SpecialPoint& point, ParameterId parameter) {
    const SpecialPoint fold = as_fold(point);
    FoldPassage result;
    result.orbit = whole_orbit(system, fold.solution.orbit);
    result.parameter = parameter;
    constexpr double tolerance = 1e-13;
    const Simulation simulation(system, {}, {}, integration(tolerance));
    Shooting equations(simulation, result.orbit, {parameter});
    OrbitEvaluation at = equations.evaluation();
    const bool followed = equations.evaluate(equations.unknowns_of(result.orbit), at);
    SecondVariation variation(equations);
    const auto form = followed ? fold_form(equations, at, variation) : std::nullopt;
    if (!form || form->coefficient == 0 || !form->is_simple)
        throw InputError("the normal form of the fold cannot be computed" +
                             (at.problem.empty() ? std::string() : ": " + at.problem),
                         "choose another fold");
    const std::string name = system.model().independent_parameters()[parameter.place()];
    if (form->rate == 0)
        throw InputError(fmt::format("'{}' does not move the orbit from its fold", name), "name a parameter that does");
    result.value = result.orbit.parameters[parameter.place()];
    result.coefficient = form->coefficient;
    result.rate = form->rate;
    result.side = form->rate > 0 ? 1 : -1;
    result.cycle = result.orbit.return_time();
    result.attracting = is_attracting(fold.solution);
    result.critical = form->critical;
    result.adjoint = form->adjoint;
    result.gate = gate_of(equations, at, *form, variation);
    return result;
}

double cycles_of_passage(const FoldPassage& fold, double overshoot) {
    if (!(overshoot * fold.side > 0 && std::isfinite(overshoot)))
        throw InputError(
            overshoot == 0
                ? std::string("at the fold itself nothing passes")
                : fmt::format("with the parameter {:+g} from the fold there are two orbits, and no trip", overshoot),
            fold.side > 0 ? "they are gone above: give a positive overshoot"
                          : "they are gone below: give a negative overshoot");
    return pi / fold.root(overshoot);
}

double cycles_of_passage(const FoldPassage& fold, double overshoot, double from, double to) {
    const double root = fold.root(overshoot);
    cycles_of_passage(fold, overshoot); // refuses an invalid overshoot
    return (std::atan(fold.coefficient * to / root) - std::atan(fold.coefficient * from / root)) / root;
}

double least_overshoot(const FoldPassage& fold) {
    // The state of a fold is known to the square root of round-off, which changes the parameter by round-off only.
    constexpr double digits = 1e-15, enough = 1e3, state_resolution = 1e-11;
    const double by_states = state_resolution * fold.gate / std::abs(fold.rate);
    return std::max(by_states, enough * digits * std::abs(fold.value));
}

SimulatedPassage simulated_passage(const System& system, const FoldPassage& fold, double overshoot, const TripEnd& end,
                                   bool until_passed, const TripOptions& options) {
    options.validate();
    cycles_of_passage(fold, overshoot);
    const Segment& closing = fold.orbit.signature.back();
    if (closing.end == SegmentEnd::cut)
        throw InputError("the orbit at the fold passes none of the sections by which cycles could be counted",
                         "declare a section that it passes, and follow the branch to its fold from there");
    std::optional<Probe> section;
    if (closing.end == SegmentEnd::section)
        section = section_probe(system.model(), system.model().sections[closing.index].name);
    const Simulation simulation = simulation_until(system, end, options, section);
    std::vector<double> parameters = fold.orbit.parameters, start = fold.orbit.starts.front();
    parameters[fold.parameter.place()] += overshoot;
    for (std::size_t i = 0; i < start.size(); ++i)
        start[i] -= fold.gate * fold.critical[i];
    ReturnWatch watch(system, fold, end, until_passed, options, -fold.gate);
    TripTime trip =
        run_until(simulation, parameters, start, fold.orbit.signature.front().mode, options.cycles * fold.cycle, watch);
    trip.cycles = trip.time / fold.cycle;
    return {watch.passed(), watch.cycles(), watch.time(), trip};
}

} // namespace graze
