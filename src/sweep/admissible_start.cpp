#include "sweep/admissible_start.hpp"

#include <cmath>
#include <limits>

namespace graze {

namespace {

constexpr std::size_t most_steps = 50;
/// Distance from a surface, relative to the size of a step, at which a state counts as on it.
constexpr double on_surface = 4 * std::numeric_limits<double>::epsilon();

} // namespace

std::optional<std::vector<double>> nearest_admissible(const System& system, std::span<const double> parameters,
                                                      std::span<const double> state, std::size_t mode) {
    const System::CompiledMode& compiled = system.mode(mode);
    const std::size_t states = system.states(), events = compiled.watched.size();
    std::vector<double> inputs(state.begin(), state.end()), values(events), gradients(events * states);
    std::vector<double> work(system.workspace()), periods(states);
    inputs.insert(inputs.end(), parameters.begin(), parameters.end());
    const std::vector<double> all(parameters.begin(), parameters.end());
    system.periods().evaluate(all, periods, work);
    for (std::size_t step = 0; step < most_steps; ++step) {
        compiled.events.evaluate(inputs, values, work);
        compiled.event_gradients.evaluate(inputs, gradients, work);
        bool moved = false;
        for (std::size_t w = 0; w < events; ++w) {
            if (system.model().events[compiled.watched[w]].kind != EventKind::barrier || values[w] >= 0)
                continue;
            if (!std::isfinite(values[w]))
                return std::nullopt;
            const double* gradient = &gradients[w * states];
            double square = 0;
            for (std::size_t i = 0; i < states; ++i)
                square += periods[i] > 0 ? 0 : gradient[i] * gradient[i];
            if (!(square > 0) || !std::isfinite(square))
                return std::nullopt;
            for (std::size_t i = 0; i < states; ++i) {
                const double change = periods[i] > 0 ? 0 : -values[w] * gradient[i] / square;
                moved = moved || std::abs(change) > on_surface * std::abs(inputs[i]);
                inputs[i] += change;
            }
            break; // the other barriers are examined in the next step
        }
        if (!moved)
            return std::vector<double>(inputs.begin(), inputs.begin() + static_cast<std::ptrdiff_t>(states));
    }
    return std::nullopt;
}

} // namespace graze
