#include "model/vanishing.hpp"

#include "base/linear_systems.hpp"
#include "graze/base/input_error.hpp"
#include "graze/symbolic/transform.hpp"
#include "symbolic/subgraph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace graze {

namespace {

constexpr int samples = 8, most_tries = 24;
constexpr std::size_t fewest = 4;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Functions that are to be zero, with their derivatives with respect to all states, row by row.
class Zeros {
public:
    Zeros(const Model& model, std::span<const Expression> zero)
        : rows_(static_cast<Eigen::Index>(zero.size())), states_(static_cast<Eigen::Index>(model.states.size())) {
        std::vector<Expression> all(zero.begin(), zero.end());
        for (const Expression& one : zero)
            for (const State& state : model.states)
                all.push_back(differentiate(one, model.symbol(state.name)));
        function_ = Function(model.inputs(), all);
    }

    /// Moves states to the nearest zero. @return false if there is none near
    bool approach(std::vector<double>& inputs) const {
        constexpr int most_steps = 40;
        constexpr double close = 1e-10; // Newton's method then doubles the digits
        if (rows_ == 0 || inputs.empty())
            return !inputs.empty();
        for (int k = 0, more = 0; k < most_steps; ++k) {
            const std::vector<double> values = function_(inputs);
            if (!std::ranges::all_of(values, [](double one) { return std::isfinite(one); }))
                return false;
            const auto derivatives =
                Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
                    values.data() + rows_, rows_, states_);
            const Eigen::VectorXd step =
                shortest_solution(derivatives, Eigen::Map<const Eigen::VectorXd>(values.data(), rows_));
            bool near = true;
            for (Eigen::Index i = 0; i < states_; ++i) {
                double& state = inputs[static_cast<std::size_t>(i)];
                near = near && std::abs(step[i]) <= close * (1 + std::abs(state));
                state -= step[i];
            }
            if (near && ++more == 2)
                return true;
        }
        return false;
    }

private:
    Eigen::Index rows_, states_;
    Function function_;
};

/// A table may be zero in one part and not in another.
bool looks_up(const Expression& expression) {
    if (expression.graph()->tables().empty())
        return false;
    const Subgraph part = subgraph_of({&expression, 1});
    return std::ranges::any_of(
        part.items, [&](const Subgraph::Item& item) { return part.node(item).operation == Operation::lookup; });
}

} // namespace

RandomInputs::RandomInputs(const Model& model) {
    try {
        states_ = model.initial_state();
        parameters_ = model.parameter_values();
    } catch (const InputError&) {
        states_.clear(); // `validate` tells what is wrong
    }
}

std::vector<double> RandomInputs::drawn() {
    std::uniform_real_distribution<double> share(-1, 1);
    std::vector<double> inputs = states_;
    if (inputs.empty())
        return inputs;
    for (double& state : inputs)
        state += (1 + std::abs(state)) * share(random_);
    for (const double value : parameters_)
        inputs.push_back(value == 0 ? share(random_) : value * (1 + 0.5 * share(random_)));
    return inputs;
}

Vanishing::Vanishing(const Model& model, RandomInputs random, std::span<const Expression> zero) : model_(model) {
    try {
        const Zeros zeros(model, zero);
        for (int tries = 0; tries < most_tries && samples_.size() < samples; ++tries)
            if (std::vector<double> inputs = random.drawn(); zeros.approach(inputs))
                samples_.push_back(std::move(inputs));
    } catch (const InputError&) {
        samples_.clear(); // `validate` tells what is wrong
    }
}

std::vector<bool> Vanishing::of(std::span<const Expression> expressions) const {
    constexpr double input_roundoff = 8 * epsilon, margin = 8;
    const std::size_t n = expressions.size();
    std::vector<bool> candidate;
    for (const Expression& one : expressions)
        candidate.push_back(!looks_up(one));
    try {
        const Function function(model_.inputs(), expressions); // nothing is left to expand
        std::vector<std::size_t> defined(n, 0);
        std::vector<double> values(n), errors, bounds(n), work(2 * function.workspace());
        for (const std::vector<double>& inputs : samples_) {
            if (std::ranges::find(candidate, true) == candidate.end())
                return candidate;
            errors.clear();
            for (const double one : inputs)
                errors.push_back(input_roundoff * (1 + std::abs(one)));
            function.evaluate(inputs, values, work);
            function.error_bounds(inputs, errors, bounds, work);
            for (std::size_t i = 0; i < n; ++i)
                if (std::isfinite(values[i]) && std::isfinite(bounds[i])) {
                    ++defined[i];
                    candidate[i] = candidate[i] && std::abs(values[i]) <= margin * bounds[i];
                }
        }
        for (std::size_t i = 0; i < n; ++i)
            candidate[i] = candidate[i] && defined[i] >= fewest;
        return candidate;
    } catch (const InputError&) {
        return std::vector<bool>(n, false); // `validate` tells what is wrong
    }
}

} // namespace graze
