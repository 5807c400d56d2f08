#include "graze/flow/second_order_flow.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <algorithm>
#include <numeric>

namespace graze {

namespace {

/// No derivatives with respect to the initial tangent are needed: they equal those with respect to the states.
std::vector<std::size_t> states_of(const System& system) {
    std::vector<std::size_t> states(system.states());
    std::iota(states.begin(), states.end(), std::size_t{0});
    return states;
}

} // namespace

SecondOrderFlow::SecondOrderFlow(const VariationalSystem& system, double tolerance, int order)
    : system_(system), flow_(system.modes(), tolerance, order, system.free(), states_of(system.system())),
      inputs_(system.modes().parameters()), start_(system.modes().states()), rows_(start_.size() * system.variables()) {
}

void SecondOrderFlow::set_parameters(std::span<const double> parameters) {
    require_size(parameters.size(), system_.system().parameters(), "independent parameters");
    parameters_.resize(parameters.size());
    std::copy(parameters.begin(), parameters.end(), parameters_.begin());
    std::copy(parameters.begin(), parameters.end(), inputs_.begin());
}

ModeFlow::Ending SecondOrderFlow::run(std::size_t mode, std::span<double> state, double duration,
                                      std::span<const double> vector, std::span<double> derivatives,
                                      std::span<double> second) {
    const std::size_t states = system_.system().states(), variables = system_.variables();
    const auto count = [](std::size_t items) { return static_cast<std::ptrdiff_t>(items); };
    require_index(mode, system_.system().model().modes.size(), "mode");
    require_size(state.size(), states, "states");
    require_size(vector.size(), variables, "components of the vector");
    require_finite(vector, "a component of the vector");
    require_size(derivatives.size(), states * variables, "derivatives");
    require_size(second.size(), states * variables, "second derivatives");
    if (parameters_.size() != system_.system().parameters())
        throw OrderError("the flow of a mode has no parameters before they are set");
    std::copy(vector.begin() + count(states), vector.end(), inputs_.begin() + count(parameters_.size()));
    flow_.set_parameters(inputs_);
    std::copy(state.begin(), state.end(), start_.begin());
    std::copy_n(vector.begin(), states, start_.begin() + count(states));
    const ModeFlow::Ending ending = flow_.run(mode, start_, duration, rows_);
    std::copy_n(start_.begin(), states, state.begin());
    std::copy_n(rows_.begin(), derivatives.size(), derivatives.begin());
    std::copy_n(rows_.begin() + count(derivatives.size()), second.size(), second.begin());
    return ending;
}

} // namespace graze
