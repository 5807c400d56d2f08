#include "testbed_course.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace peers {

Course::Course(int periods)
    : one(testbed_case(periods)), start(nondimensional(one.start)), phase(one.start[3]),
      input_units(one.units.begin(), one.units.end()) {
    const std::array numbers = {groups.voltage, groups.damping, groups.resistance, groups.inductance};
    for (const double number : numbers) {
        const std::vector parameter{one.model.symbol(inputs[input_units.size()])};
        input_units.push_back(one.model.values_of(parameter)[0] / number);
    }
}

Course::State Course::nondimensional(std::span<const double> state) const {
    return {state[0] / one.units[0], state[1] / one.units[1], state[2] / one.units[2]};
}

Reference Course::reference(const Motions& motions) const {
    Reference result(*motions.exact, static_cast<Reference::Real>(one.longest_step) / one.time_unit);
    result.begin({start[0], start[1], start[2], phase}, one.mode);
    return result;
}

Reference::Real Course::duration_of_graze() const {
    return static_cast<Reference::Real>(one.duration) / one.time_unit;
}

Reference::Real Course::duration_of_heyoka() const {
    const double begin = phase / groups.frequency, end = begin + duration();
    return static_cast<Reference::Real>(end) - begin;
}

Truth::Truth(const Course& course, Reference::Real duration) {
    Reference reference = course.reference();
    for (int count = 1;; ++count) {
        const Reference::Real time =
            (count * std::numbers::pi_v<Reference::Real> - course.phase) / course.groups.frequency;
        if (time >= duration)
            break;
        reference.advance(time);
        sections.push_back(state_of(reference));
    }
    reference.advance(duration);
    end = state_of(reference);
    impacts = reference.meetings.size();
    constexpr std::size_t known = 5; // the reference has derivatives by all four states and the voltage
    for (std::size_t d = 0; d < known; ++d) {
        Course::State& column = columns.emplace_back();
        for (std::size_t k = 0; k < column.size(); ++k)
            column[k] = static_cast<double>(reference.derivative(k, d));
    }
}

Course::State state_of(const Reference& reference) {
    Course::State result;
    for (std::size_t k = 0; k < result.size(); ++k)
        result[k] = static_cast<double>(reference.state(k));
    return result;
}

double largest_difference(const Course::State& a, const Course::State& b) {
    double result = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        result = std::max(result, std::abs(a[k] - b[k]));
    return result;
}

} // namespace peers
