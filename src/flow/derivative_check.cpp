#include "graze/flow/derivative_check.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/require.hpp"
#include "graze/flow/mode_flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace graze {

namespace {

/// Numbers that depend on states and parameters. Empty where they are not defined.
using Values = std::function<std::vector<double>(const std::vector<double>& inputs)>;

struct Difference {
    double value = 0, error = infinity;
};

/// Derivatives of all values by one input: central differences at smaller and smaller steps, extrapolated to none, each
/// with the error that they tell of themselves (C. J. F. Ridders, Adv. Eng. Softw. 4 (1982) 75).
std::vector<Difference> differences(const Values& values, std::vector<double> inputs, std::size_t input) {
    constexpr std::size_t rows = 8;
    constexpr double first = 0.01, smaller = 1.8;
    const double at = inputs[input];
    double step = first * (at == 0 ? 1 : std::abs(at));
    std::vector<Difference> best;
    std::array<std::array<std::vector<double>, rows>, rows> table;
    for (std::size_t i = 0; i < rows; ++i, step /= smaller) {
        inputs[input] = at + step;
        std::vector<double> above = values(inputs);
        inputs[input] = at - step;
        const std::vector<double> below = values(inputs);
        if (above.empty() || below.empty())
            return {};
        best.resize(above.size());
        for (std::size_t k = 0; k < above.size(); ++k)
            above[k] = (above[k] - below[k]) / (2 * step);
        table[0][i] = std::move(above);
        double factor = smaller * smaller;
        for (std::size_t j = 1; j <= i; ++j, factor *= smaller * smaller) {
            table[j][i].resize(best.size());
            for (std::size_t k = 0; k < best.size(); ++k) {
                const double here = table[j - 1][i][k], before = table[j - 1][i - 1][k];
                const double next = table[j][i][k] = here + (here - before) / (factor - 1);
                if (const double error = std::max(std::abs(next - here), std::abs(next - before));
                    error < best[k].error)
                    best[k] = {next, error};
            }
        }
    }
    return best;
}

class DerivativeChecker {
public:
    DerivativeChecker(const System& system, std::span<const double> state, std::span<const double> parameters,
                      const DerivativeCheckOptions& options)
        : system_(system), options_(options), inputs_(state.begin(), state.end()) {
        inputs_.insert(inputs_.end(), parameters.begin(), parameters.end());
        for (const State& one : system.model().states)
            names_.push_back(one.name);
        for (const std::string& name : system.model().independent_parameters())
            names_.push_back(name);
    }

    std::vector<DerivativeFinding> run() {
        const Model& model = system_.model();
        for (std::size_t m = 0; m < model.modes.size(); ++m)
            check_mode(m);
        for (std::size_t e = 0; e < model.events.size(); ++e)
            check_gradient("events." + model.events[e].name, "the function", system_.event(e));
        for (std::size_t s = 0; s < model.sections.size(); ++s)
            check_gradient("sections." + model.sections[s].name, "the function", system_.section(s));
        for (std::size_t j = 0; j < model.jumps.size(); ++j)
            if (!system_.jump(j).identity)
                check_jump(j);
        return std::move(findings_);
    }

private:
    std::size_t states() const { return system_.states(); }

    /// @param outputs what the values are, such as "the rate of v"; @param exact derivatives by all inputs, row by row
    void compare_derivatives(const std::string& part, const std::vector<std::string>& outputs, const Values& values,
                             const std::vector<double>& exact) {
        std::vector<double> sizes(outputs.size(), 0.0);
        for (std::size_t k = 0; k < outputs.size(); ++k)
            for (std::size_t i = 0; i < inputs_.size(); ++i)
                if (const double size = std::abs(exact[k * inputs_.size() + i]); std::isfinite(size))
                    sizes[k] = std::max(sizes[k], size);
        for (std::size_t i = 0; i < inputs_.size(); ++i) {
            const std::vector<Difference> found = differences(values, inputs_, i);
            for (std::size_t k = 0; k < found.size(); ++k) {
                const double known = exact[k * inputs_.size() + i], allowed = options_.tolerance * (sizes[k] + 1e-3);
                const bool is_told = std::isfinite(found[k].value) && found[k].error < allowed;
                constexpr double doubt = 10; // the error is what differences tell of themselves
                if (!std::isfinite(known))
                    findings_.push_back({part, fmt::format("{} by {}", outputs[k], names_[i]), known, known, 0});
                else if (is_told && !(std::abs(known - found[k].value) <= allowed + doubt * found[k].error))
                    findings_.push_back(
                        {part, fmt::format("{} by {}", outputs[k], names_[i]), known, found[k].value, found[k].error});
            }
        }
    }

    /// A function whose value comes first, and then its derivatives by states and parameters.
    void check_gradient(const std::string& part, const std::string& output, const Function& function) {
        const std::vector<double> all = function(inputs_);
        if (!std::isfinite(all[0])) {
            findings_.push_back({part, output, all[0], all[0], 0});
            return;
        }
        compare_derivatives(part, {output}, [&](const auto& inputs) { return std::vector{function(inputs)[0]}; },
                            {all.begin() + 1, all.end()});
    }

    void check_mode(std::size_t m) {
        Model model = system_.model(); // whose graph may grow
        const std::string part = "modes." + model.modes[m].name;
        const std::vector<Expression> rates = model.expand(model.modes[m].rates);
        for (std::size_t i = 0; i < states(); ++i) {
            const Function rate = system_.with_gradient(rates[i]);
            // Powers of an event's function do not exist beyond the end of a mode, where the state may be.
            if (!system_.mode(m).ends_at_root || std::isfinite(rate(inputs_)[0]))
                check_gradient(part, "the rate of " + names_[i], rate);
        }
        check_flow(m, part);
    }

    /// Time in which the state changes by a share of its size, for differences not to meet what is far.
    double duration_of(std::size_t m) const {
        if (options_.duration > 0)
            return options_.duration;
        const std::vector<double> rates = system_.mode(m).rates(inputs_);
        double fastest = 0;
        for (std::size_t i = 0; i < states(); ++i)
            fastest = std::max(fastest, std::abs(rates[i]) / std::max(1.0, std::abs(inputs_[i])));
        constexpr double share = 0.1;
        return std::isfinite(fastest) ? share / std::max(fastest, 1e-3) : 0;
    }

    /// The duration, or as many tenths of it less as leave few steps to a motion that begins beside the state: at rest
    /// rates do not tell how fast that is.
    template <class Split>
    double shortened(ModeFlow& flow, std::size_t m, double duration, const Split& split) const {
        constexpr std::size_t most_steps = 20;
        constexpr double displacement = 0.01;
        std::vector<double> beside = inputs_;
        for (std::size_t i = 0; i < states(); ++i)
            beside[i] += displacement * (beside[i] == 0 ? 1 : std::abs(beside[i]));
        const auto [start, parameters] = split(beside);
        flow.set_parameters(parameters);
        for (double share = 1e-12; share < 1; share *= 10) {
            std::vector<double> state = start;
            const std::size_t before = flow.steps();
            if (flow.run(m, state, share * duration) != ModeFlow::Ending::done || flow.steps() - before > most_steps)
                return share * duration;
        }
        return duration;
    }

    void check_flow(std::size_t m, const std::string& part) {
        double duration = duration_of(m);
        if (!(duration > 0))
            return;
        std::vector<ParameterId> free;
        for (std::size_t p = 0; p < system_.parameters(); ++p)
            free.emplace_back(p);
        ModeFlow flow(system_, 1e-13, 0, free);
        const auto split = [&](const std::vector<double>& inputs) {
            return std::pair(std::vector(inputs.begin(), inputs.begin() + static_cast<std::ptrdiff_t>(states())),
                             std::vector(inputs.begin() + static_cast<std::ptrdiff_t>(states()), inputs.end()));
        };
        if (!(options_.duration > 0))
            duration = shortened(flow, m, duration, split);
        auto [end, parameters] = split(inputs_);
        std::vector<double> exact(states() * inputs_.size());
        flow.set_parameters(parameters);
        if (flow.run(m, end, duration, exact) != ModeFlow::Ending::done)
            return; // nothing that lasts so long begins there
        std::vector<std::string> outputs;
        for (std::size_t i = 0; i < states(); ++i)
            outputs.push_back(fmt::format("{} after {:.3g}", names_[i], duration));
        compare_derivatives(
            part, outputs,
            [&](const std::vector<double>& inputs) {
                auto [state, given] = split(inputs);
                flow.set_parameters(given);
                return flow.run(m, state, duration) == ModeFlow::Ending::done ? state : std::vector<double>();
            },
            exact);
    }

    void check_jump(std::size_t j) {
        const System::CompiledJump& jump = system_.jump(j);
        std::vector<double> exact(states() * inputs_.size(), 0.0);
        for (std::size_t i = 0; i < states(); ++i)
            exact[i * inputs_.size() + i] = 1; // of states that stay
        for (const std::size_t row : jump.changed)
            exact[row * inputs_.size() + row] = 0;
        const std::vector<double> entries = jump.jacobian(inputs_);
        for (std::size_t k = 0; k < jump.entries.size(); ++k)
            exact[jump.entries[k].row * inputs_.size() + jump.entries[k].column] = entries[k];
        std::vector<std::string> outputs;
        for (std::size_t i = 0; i < states(); ++i)
            outputs.push_back(names_[i] + " behind");
        compare_derivatives(
            "jumps." + system_.model().jumps[j].name, outputs,
            [&](const std::vector<double>& inputs) { return jump.map(inputs); }, exact);
    }

    const System& system_;
    const DerivativeCheckOptions& options_;
    std::vector<double> inputs_;
    std::vector<std::string> names_; ///< of states, then of parameters
    std::vector<DerivativeFinding> findings_;
};

} // namespace

std::string DerivativeFinding::text() const {
    return std::isfinite(exact) || std::isfinite(difference)
               ? fmt::format("the derivative of {} is {:.10g}, where differences give {:.10g} (to {:.1g})", what, exact,
                             difference, error)
               : fmt::format("{} is not defined at the state", what);
}

std::vector<DerivativeFinding> check_derivatives(const System& system, std::span<const double> state,
                                                 std::span<const double> parameters,
                                                 const DerivativeCheckOptions& options) {
    require_size(state.size(), system.states(), "states");
    require_size(parameters.size(), system.parameters(), "parameters");
    require_finite(state, "a state");
    require_finite(parameters, "a parameter");
    return DerivativeChecker(system, state, parameters, options).run();
}

} // namespace graze
