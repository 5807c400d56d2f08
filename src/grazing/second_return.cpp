#include "grazing/return_map.hpp"

#include "base/concatenated.hpp"
#include "flow/lie_derivative.hpp"
#include "graze/flow/second_order_flow.hpp"
#include "orbit/certify.hpp"

#include <array>
#include <vector>

namespace graze {

namespace {

/// Propagates a state x + s first + s^2 second along an orbit.
class SecondOrderCarrier {
public:
    SecondOrderCarrier(const OrbitEquations& equations, const OrbitEvaluation& at, const ReturnMap& back,
                       const TouchFunctions& functions)
        : equations_(equations), at_(at), back_(back), functions_(functions), n_(index(equations.layout().states())),
          system_(equations.system()), flow_(system_, equations.simulation().options().tolerance) {
        flow_.set_parameters(at.parameters);
    }

    std::optional<SecondGain> propagate(const Eigen::VectorXd& first, const Eigen::VectorXd& second) {
        first_ = first;
        second_ = second;
        const std::size_t pieces = equations_.layout().pieces();
        std::vector<double> state = back_.touch.state;
        if (!follow(back_.piece, state, duration(back_.piece) - back_.time))
            return std::nullopt;
        pass_end(back_.piece);
        for (std::size_t k = 1; k < pieces; ++k) {
            const std::size_t piece = (back_.piece + k) % pieces;
            state = start(piece);
            if (!follow(piece, state, duration(piece)))
                return std::nullopt;
            pass_end(piece);
        }
        state = start(back_.piece);
        if (!follow(back_.piece, state, back_.time))
            return std::nullopt;
        return at_touch(state);
    }

private:
    double duration(std::size_t piece) const { return at_.unknowns[index(equations_.layout().duration_of(piece))]; }
    std::vector<double> start(std::size_t piece) const {
        const double* first = at_.unknowns.data() + equations_.layout().start_of(piece);
        return {first, first + n_};
    }

    bool follow(std::size_t piece, std::vector<double>& state, double time) {
        RowMajor derivatives(n_, n_), along(n_, n_);
        const std::vector<double> vector(first_.begin(), first_.end());
        if (flow_.run(equations_.mode_of(piece), state, time, vector, numbers_of(derivatives), numbers_of(along)) !=
            ModeFlow::Ending::done)
            return false;
        second_ = (derivatives * second_ + 0.5 * (along * first_)).eval();
        first_ = (derivatives * first_).eval();
        return true;
    }

    /// Returns the inputs of functions of the variational system, contracted with the first-order gain.
    std::vector<double> inputs_at(const std::vector<double>& state) const {
        return concatenated(state, at_.parameters, first_);
    }

    /// Returns the derivative of a mode's rates along a vector.
    Eigen::VectorXd rate_along(std::size_t mode, const std::vector<double>& state,
                               const Eigen::VectorXd& vector) const {
        const std::vector<double> rates = system_.modes().mode(mode).rates(concatenated(state, vector, at_.parameters));
        return Eigen::Map<const Eigen::VectorXd>(rates.data() + n_, n_);
    }

    /// Moves the end of the motion from a fixed time to the zero of a function, to second order in the shift of time.
    void onto_surface(std::size_t mode, const std::vector<double>& state, const Function& function) {
        const Eigen::VectorXd field = field_of(mode, state);
        const std::vector<double> there = function(inputs_at(state));
        const Eigen::Map<const Eigen::RowVectorXd> gradient(there.data() + 1, n_);
        const double rate = gradient.dot(field), later = -gradient.dot(first_) / rate;
        second_ += later * rate_along(mode, state, first_) + 0.5 * later * later * rate_along(mode, state, field);
        first_ += later * field;
        const std::vector<double> curved = function(inputs_at(state));
        const Eigen::Map<const Eigen::RowVectorXd> along(curved.data() + 1 + n_, n_);
        second_ -= field * ((gradient.dot(second_) + 0.5 * along.dot(first_)) / rate);
    }

    Eigen::VectorXd field_of(std::size_t mode, const std::vector<double>& state) const {
        const std::vector<double> field = equations_.system().mode(mode).rates(concatenated(state, at_.parameters));
        return Eigen::Map<const Eigen::VectorXd>(field.data(), n_);
    }

    void pass(const Function& map, std::vector<double>& state) {
        const std::vector<double> values = map(inputs_at(state));
        const Eigen::Map<const RowMajor> derivatives(values.data() + n_, n_, n_),
            along(derivatives.data() + n_ * n_, n_, n_);
        second_ = (derivatives * second_ + 0.5 * (along * first_)).eval();
        first_ = (derivatives * first_).eval();
        state.assign(values.begin(), values.begin() + n_);
    }

    void pass_end(std::size_t piece) {
        const OrbitLayout& layout = equations_.layout();
        if (!layout.is_last(piece))
            return;
        const std::size_t s = layout.segment_of(piece);
        const Segment& segment = equations_.signature()[s];
        std::vector<double> state = at_.pieces[piece].end;
        if (segment.end == SegmentEnd::event && !is_identity_transition(equations_.system(), segment.index)) {
            const Transition& transition = equations_.model().transitions[segment.index];
            onto_surface(equations_.mode_of(piece), state, system_.event(transition.event));
            pass(system_.jump(transition.jump), state);
        }
        if (equations_.symmetry() && s + 1 == layout.segments())
            pass(system_.symmetry(*equations_.symmetry()), state);
    }

    std::optional<SecondGain> at_touch(const std::vector<double>& state) {
        const Expression rate = rate_of(equations_.system(), functions_.mode(), functions_.event());
        onto_surface(functions_.mode(), state, system_.function_of(std::array{rate}));
        const std::vector<double> value = system_.event(functions_.event())(inputs_at(state));
        const Eigen::Map<const Eigen::RowVectorXd> gradient(value.data() + 1, n_), along(value.data() + 1 + n_, n_);
        SecondGain gain{first_, second_, gradient.dot(second_) + 0.5 * along.dot(first_)};
        return gain.first.allFinite() && gain.second.allFinite() ? std::optional(gain) : std::nullopt;
    }

    const OrbitEquations& equations_;
    const OrbitEvaluation& at_;
    const ReturnMap& back_;
    const TouchFunctions& functions_;
    Eigen::Index n_;
    VariationalSystem system_;
    SecondOrderFlow flow_;
    Eigen::VectorXd first_, second_;
};

} // namespace

std::optional<SecondGain> second_return(const OrbitEquations& equations, const OrbitEvaluation& at,
                                        const ReturnMap& back, const TouchFunctions& functions,
                                        const Eigen::VectorXd& first, const Eigen::VectorXd& second) {
    if (equations.has_chatter()) // second derivatives of the accumulation are not known
        return std::nullopt;
    return SecondOrderCarrier(equations, at, back, functions).propagate(first, second);
}

} // namespace graze
