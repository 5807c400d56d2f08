#include "orbit/segment_ends.hpp"

#include "flow/cyclic.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

SegmentEnds::SegmentEnds(const System& system, const Orbit& orbit, std::vector<ParameterId> free)
    : system_(system), signature_(orbit.signature), symmetry_(orbit.symmetry), free_(std::move(free)),
      n_(system.states()), periods_(n_), inputs_(n_ + system.parameters()), work_(system.workspace()),
      values_(std::max({1 + n_ + system.parameters(), n_ * system.parameters(), system.jacobian_entries()})),
      period_rates_(Eigen::MatrixXd::Zero(index(n_), index(free_.size()))) {
    for (std::size_t k = 0; k < signature_.size(); ++k) {
        const Segment& segment = signature_[k];
        EndFunction end;
        if (const Transition* const transition = transition_of(system_.model(), segment)) {
            end.value = &system_.event(transition->event);
        } else if (segment.end == SegmentEnd::cut) {
            end.normal = end.through = Eigen::VectorXd::Zero(index(n_)); // until lay_cuts
        } else if (segment.end == SegmentEnd::section) {
            const Section& section = system_.model().sections[segment.index];
            end.cyclic = section.state.has_value();
            end.state = section.state.value_or(0);
            // The last segment of a half orbit ends where its image passes the section.
            const bool at_image = symmetry_ && k + 1 == signature_.size();
            end.value = &system_.section(segment.index, at_image ? symmetry_ : std::nullopt);
        }
        ends_.push_back(end);
    }
    set_parameters(orbit.parameters);
}

void SegmentEnds::set_parameters(std::span<const double> parameters) {
    parameters_.assign(parameters.begin(), parameters.end());
    std::ranges::copy(parameters, inputs_.begin() + static_cast<std::ptrdiff_t>(n_));
    system_.periods().evaluate(parameters_, periods_, work_);
    const std::size_t count = parameters_.size();
    system_.period_gradients().evaluate(parameters_, std::span(values_).first(n_ * count), work_);
    for (std::size_t i = 0; i < n_; ++i)
        for (std::size_t f = 0; f < free_.size(); ++f)
            period_rates_(index(i), index(f)) = values_[i * count + free_[f].place()];
}

void SegmentEnds::lay_cuts(const Orbit& orbit, const Eigen::VectorXd& scales) {
    Eigen::VectorXd rates;
    for (std::size_t k = 0; k < ends_.size(); ++k) {
        if (signature_[k].end != SegmentEnd::cut)
            continue;
        const std::size_t next = (k + 1) % ends_.size();
        const std::vector<double>& start = orbit.starts[next];
        field(next, start, rates);
        for (std::size_t i = 0; i < n_; ++i) // the position of a drifting state is arbitrary
            if (system_.model().states[i].drifting)
                rates[index(i)] = 0;
        const Eigen::VectorXd direction = rates.cwiseQuotient(scales);
        const double size = direction.norm();
        ends_[k].through = Eigen::Map<const Eigen::VectorXd>(start.data(), index(n_));
        ends_[k].normal = direction.cwiseQuotient(scales) / (size > 0 ? size : 1);
    }
}

/// Returns the signed distance of a state from the plane of a cut. @param turns if not null, set to the whole periods
/// of cyclic states that were removed from the difference
double SegmentEnds::off_cut(const EndFunction& end, std::span<const double> after, Eigen::VectorXd* turns) const {
    double off = 0;
    for (std::size_t i = 0; i < n_; ++i) {
        const double difference = after[i] - end.through[index(i)], part = without_turns(difference, periods_[i]);
        off += end.normal[index(i)] * part;
        if (turns && periods_[i] > 0)
            (*turns)[index(i)] = std::round((difference - part) / periods_[i]);
    }
    return off;
}

/// Sets the end condition of a cut, a function of the start of the next segment.
void SegmentEnds::pass_cut(const EndFunction& end, OrbitEvaluation::Piece& piece) const {
    Eigen::VectorXd turns = Eigen::VectorXd::Zero(index(n_));
    piece.condition_value = off_cut(end, piece.after, &turns);
    piece.condition = piece.jump.transpose() * end.normal;
    piece.condition.tail(index(free_.size())) -= period_rates_.transpose() * turns.cwiseProduct(end.normal);
}

Eigen::VectorXd SegmentEnds::gradient_of(std::span<const double> values) const {
    Eigen::VectorXd gradient(index(n_ + free_.size()));
    for (std::size_t i = 0; i < n_; ++i)
        gradient[index(i)] = values[1 + i];
    for (std::size_t f = 0; f < free_.size(); ++f)
        gradient[index(n_ + f)] = values[1 + n_ + free_[f].place()];
    return gradient;
}

void SegmentEnds::field(std::size_t segment, std::span<const double> state, Eigen::VectorXd& result) {
    std::ranges::copy(state, inputs_.begin());
    result.resize(index(n_));
    system_.mode(signature_[segment].mode).rates.evaluate(inputs_, {result.data(), n_}, work_);
}

const Function* SegmentEnds::condition_of(std::size_t k, Passed passed) const {
    return passed == Passed::end && signature_[k].end == SegmentEnd::chatter ? nullptr : ends_[k].value;
}

std::vector<const System::CompiledJump*> SegmentEnds::jumps_of(std::size_t k, Passed passed) const {
    std::vector<const System::CompiledJump*> jumps;
    const Segment& segment = signature_[k];
    const Transition* const transition = transition_of(system_.model(), segment);
    if (transition && segment.end == SegmentEnd::chatter && passed == Passed::end)
        jumps.push_back(&system_.jump(transition->chatter->jump));
    else if (transition)
        jumps.push_back(&system_.jump(transition->jump));
    if (symmetry_ && k + 1 == signature_.size() && passed == Passed::end)
        jumps.push_back(&system_.symmetry(*symmetry_));
    return jumps;
}

bool SegmentEnds::pass(std::size_t k, OrbitEvaluation::Piece& piece, Passed passed) {
    std::ranges::copy(piece.end, inputs_.begin());
    const EndFunction& end = ends_[k];
    if (const Function* const condition = condition_of(k, passed)) {
        const std::span<double> values = std::span(values_).first(condition->outputs());
        condition->evaluate(inputs_, values, work_);
        piece.condition_value = values[0];
        piece.condition = gradient_of(values);
    }
    if (end.cyclic) {
        const double turns = std::round(piece.condition_value / periods_[end.state]);
        piece.condition_value -= turns * periods_[end.state];
        piece.condition.tail(index(free_.size())) -= turns * period_rates_.row(index(end.state)).transpose();
    }
    for (const System::CompiledJump* const jump : jumps_of(k, passed))
        apply(*jump, piece);
    if (end.normal.size() > 0)
        pass_cut(end, piece);
    return std::ranges::all_of(piece.after, [](double value) { return std::isfinite(value); });
}

bool SegmentEnds::pass(std::size_t k, std::vector<double>& state, double& condition, Passed passed) {
    std::ranges::copy(state, inputs_.begin());
    const EndFunction& end = ends_[k];
    if (const Function* const function = condition_of(k, passed)) {
        const std::span<double> values = std::span(values_).first(function->outputs());
        function->evaluate(inputs_, values, work_);
        condition = end.cyclic ? without_turns(values[0], periods_[end.state]) : values[0];
    }
    for (const System::CompiledJump* const jump : jumps_of(k, passed)) {
        std::ranges::copy(state, inputs_.begin());
        if (!jump->identity)
            jump->map.evaluate(inputs_, state, work_);
    }
    if (end.normal.size() > 0)
        condition = off_cut(end, state, nullptr);
    return std::ranges::all_of(state, [](double value) { return std::isfinite(value); });
}

/// Applies a map of states after the previous ones, with derivatives by the chain rule.
void SegmentEnds::apply(const System::CompiledJump& map, OrbitEvaluation::Piece& piece) {
    if (map.identity)
        return;
    std::ranges::copy(piece.after, inputs_.begin());
    map.jacobian.evaluate(inputs_, values_, work_);
    std::vector<std::size_t> free_place(parameters_.size(), free_.size());
    for (std::size_t f = 0; f < free_.size(); ++f)
        free_place[free_[f].place()] = f;
    Eigen::MatrixXd product = piece.jump;
    for (const std::size_t i : map.changed)
        product.row(index(i)).setZero();
    for (std::size_t k = 0; k < map.entries.size(); ++k) {
        const auto [i, j] = map.entries[k];
        if (j < n_)
            product.row(index(i)) += values_[k] * piece.jump.row(index(j));
        else if (const std::size_t f = free_place[j - n_]; f < free_.size())
            product(index(i), index(n_ + f)) += values_[k];
    }
    map.map.evaluate(inputs_, piece.after, work_);
    piece.jump = std::move(product);
}

} // namespace graze
