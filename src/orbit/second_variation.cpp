#include "orbit/second_variation.hpp"

#include "base/concatenated.hpp"

#include <algorithm>

namespace graze {

SecondVariation::SecondVariation(const OrbitEquations& equations)
    : system_(equations.system(), equations.free()),
      flow_(system_, equations.simulation().options().tolerance, equations.simulation().order()),
      states_(equations.layout().states()), free_(equations.layout().free()),
      work_(std::max(system_.workspace(), system_.modes().workspace())) {}

bool SecondVariation::contract(const OrbitEquations& equations, const OrbitEvaluation& at, const Eigen::MatrixXd& left,
                               const Eigen::VectorXd& right, Eigen::MatrixXd& gradients) {
    if (equations.has_chatter()) // second derivatives of the time and state of accumulation are not known
        return false;
    const OrbitLayout& layout = equations.layout();
    const auto n = index(states_), q = index(free_);
    gradients = Eigen::MatrixXd::Zero(left.cols(), index(layout.unknowns()));
    parameters_ = at.parameters;
    flow_.set_parameters(parameters_);
    Tangent tangent;
    for (std::size_t k = 0; k < layout.pieces(); ++k) {
        const Eigen::Index place = index(layout.start_of(k));
        const Eigen::VectorXd gain = right.segment(place, n);
        if (!follow(equations, at, k, gain, right[place + n], tangent))
            return false;
        Eigen::MatrixXd weights = left.middleRows(place, n + 1);
        Eigen::MatrixXd change = Eigen::MatrixXd::Zero(left.cols(), n + 1 + q);
        if (layout.is_last(k)) {
            const std::size_t s = layout.segment_of(k);
            const Segment& segment = equations.signature()[s];
            const bool half = equations.symmetry() && s + 1 == layout.segments();
            const bool event = segment.end == SegmentEnd::event, cut = segment.end == SegmentEnd::cut;
            const Transition* transition = event ? &equations.model().transitions[segment.index] : nullptr;
            if (!cut) {
                evaluate(event ? system_.event(transition->event)
                               : system_.section(segment.index, half ? equations.symmetry() : std::nullopt),
                         tangent);
                change += weights.row(0).transpose() * derivative_of_gain(tangent, 1);
            }
            if (event)
                pass(system_.jump(transition->jump), tangent);
            if (half)
                pass(system_.symmetry(*equations.symmetry()), tangent);
            if (cut) // the condition of a cut is linear in the start of the next segment
                change += weights.row(0).transpose() * (equations.cut_normal(s).transpose() * tangent.of_gain);
        }
        if (k + 1 == layout.pieces()) // neutral and drifting states are held, not closed
            for (std::size_t i = 0; i < states_; ++i)
                if (std::ranges::find(at.active, i) == at.active.end())
                    weights.row(1 + index(i)).setZero();
        for (std::size_t i = 0; k + 1 == layout.pieces() && i < states_; ++i)
            if (const auto& with = equations.model().states[i].drifts_with)
                weights.row(1 + index(*with)) -= weights.row(1 + index(i));
        if (const CycleEnds* const ends = equations.cycle_ends(); ends && k + 1 == layout.pieces())
            change += weights.bottomRows(n).transpose() * ends->by_end() * tangent.of_gain;
        else
            change -= weights.bottomRows(n).transpose() * tangent.of_gain;
        gradients.middleCols(place, n + 1) += change.leftCols(n + 1);
        gradients.rightCols(q) += change.rightCols(q);
    }
    return gradients.allFinite();
}

/// Computes the end of a piece and its variation along the directions `gain` of the start and `longer` of the duration.
bool SecondVariation::follow(const OrbitEquations& equations, const OrbitEvaluation& at, std::size_t piece,
                             const Eigen::VectorXd& gain, double longer, Tangent& result) {
    const auto n = index(states_), q = index(free_);
    const double* start = at.unknowns.data() + equations.layout().start_of(piece);
    const std::size_t mode = equations.mode_of(piece);
    result.state.assign(start, start + n);
    std::vector<double> vector(gain.begin(), gain.end());
    vector.resize(system_.variables(), 0.0);
    RowMajor first(n, n + q), second(n, n + q);
    if (flow_.run(mode, result.state, at.unknowns[index(equations.layout().duration_of(piece))], vector,
                  numbers_of(first), numbers_of(second)) != ModeFlow::Ending::done)
        return false;
    // The variation of the end is (x_e)_x v + f tau, with the rates f at the end; its derivatives need those of f.
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(q), carried = first.leftCols(n) * gain;
    const Eigen::VectorXd by_time = rate_along(mode, result.state, carried, zero);
    const Eigen::VectorXd field = Eigen::Map<const Eigen::VectorXd>(values_.data(), n);
    result.gain = carried + longer * field;
    result.of_state.resize(n, n + 1 + q);
    result.of_gain.resize(n, n + 1 + q);
    result.of_state << first.leftCols(n), field, first.rightCols(q);
    result.of_gain << second.leftCols(n), by_time, second.rightCols(q);
    for (Eigen::Index j = 0; j < n + 1 + q && longer != 0; ++j) {
        Eigen::VectorXd by_parameters = zero;
        if (j > n)
            by_parameters[j - n - 1] = 1;
        result.of_gain.col(j) += longer * rate_along(mode, result.state, result.of_state.col(j), by_parameters);
    }
    return true;
}

/// Returns the directional derivative of a mode's rates; `values_` then begins with the rates.
Eigen::VectorXd SecondVariation::rate_along(std::size_t mode, const std::vector<double>& state,
                                            const Eigen::VectorXd& by_state, const Eigen::VectorXd& by_parameters) {
    inputs_ = concatenated(state, by_state, parameters_, by_parameters);
    values_.resize(2 * states_);
    system_.modes().mode(mode).rates.evaluate(inputs_, values_, work_);
    return Eigen::Map<const Eigen::VectorXd>(values_.data() + states_, index(states_));
}

/// Evaluates a function with first derivatives and second derivatives contracted with the variation of the state.
void SecondVariation::evaluate(const Function& function, const Tangent& tangent) {
    inputs_ = concatenated(tangent.state, parameters_, tangent.gain);
    inputs_.resize(inputs_.size() + free_, 0.0);
    values_.resize(function.outputs());
    function.evaluate(inputs_, values_, work_);
}

/// Returns the derivatives of h_x times the variation with respect to start, duration and free parameters, after
/// `evaluate`.
Eigen::MatrixXd SecondVariation::derivative_of_gain(const Tangent& tangent, std::size_t values) const {
    const auto n = index(states_), q = index(free_), count = index(values);
    const Eigen::Map<const RowMajor> first(values_.data() + values, count, n + q),
        second(first.data() + first.size(), count, n + q);
    Eigen::MatrixXd result = first.leftCols(n) * tangent.of_gain + second.leftCols(n) * tangent.of_state;
    result.rightCols(q) += second.rightCols(q);
    return result;
}

void SecondVariation::pass(const Function& map, Tangent& tangent) {
    const auto n = index(states_), q = index(free_);
    evaluate(map, tangent);
    tangent.of_gain = derivative_of_gain(tangent, states_);
    const Eigen::Map<const RowMajor> first(values_.data() + n, n, n + q);
    tangent.of_state = Eigen::MatrixXd(first.leftCols(n) * tangent.of_state);
    tangent.of_state.rightCols(q) += first.rightCols(q);
    tangent.gain = Eigen::VectorXd(first.leftCols(n) * tangent.gain);
    tangent.state.assign(values_.begin(), values_.begin() + n);
}

} // namespace graze
