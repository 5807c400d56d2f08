#include "graze/orbit/orbit.hpp"

#include "base/concatenated.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "orbit/cut.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace graze {

double Orbit::return_time() const {
    return std::accumulate(durations.begin(), durations.end(), 0.0);
}

double Orbit::period() const {
    return return_time() * (symmetry ? 2 : 1);
}

namespace {

/// True when one function is the image of another, judged by their values at and near states of an orbit. Images of
/// cyclic states are shifted by `turns` periods, because events of a clock may hold in one period only, as `pi - theta`
/// and `2*pi - theta`.
bool is_image(const Function& own, const Function& other, const Function& map, const Orbit& orbit,
              std::span<const double> periods, double turns) {
    constexpr double nothing = 1e-9; // states below this are round-off of zero and give no scale
    const std::size_t states = periods.size();
    std::vector<double> sizes(periods.begin(), periods.end());
    for (const std::vector<double>& start : orbit.starts)
        for (std::size_t i = 0; i < states; ++i)
            sizes[i] = std::max(sizes[i], std::abs(start[i]));
    double size = 0, difference = 0;
    for (const std::vector<double>& start : orbit.starts)
        // Away from the orbit too: different functions may coincide on the orbit.
        for (const double displacement : {0.0, 0.37, -0.61}) {
            std::vector<double> state = start;
            for (std::size_t i = 0; i < states; ++i)
                state[i] += displacement * (sizes[i] > nothing ? sizes[i] : 1) / static_cast<double>(i + 2);
            std::vector<double> image_state = map(concatenated(state, orbit.parameters));
            for (std::size_t i = 0; i < states; ++i)
                image_state[i] += turns * periods[i];
            const double value = own(concatenated(state, orbit.parameters))[0],
                         image = other(concatenated(image_state, orbit.parameters))[0];
            if (std::isfinite(value) != std::isfinite(image))
                return false;
            if (std::isfinite(value)) {
                size = std::max({size, std::abs(value), std::abs(image)});
                difference = std::max(difference, std::abs(value - image));
            }
        }
    return difference <= 1e-9 * size;
}

/// True when the jump of one transition is the image of that of another, judged at states of an orbit: of several
/// transitions of an event, they are the same case.
bool has_image_jump(const System& system, std::size_t symmetry, std::size_t own, std::size_t other,
                    const Orbit& orbit) {
    const Function& map = system.symmetry(symmetry).map;
    const auto jumped = [&](std::size_t transition, const std::vector<double>& state) {
        const System::CompiledJump& jump = system.jump(system.transition(transition).jump);
        return jump.identity ? state : jump.map(concatenated(state, orbit.parameters));
    };
    for (const std::vector<double>& start : orbit.starts) {
        const std::vector<double> one = map(concatenated(jumped(own, start), orbit.parameters)),
                                  two = jumped(other, map(concatenated(start, orbit.parameters)));
        for (std::size_t i = 0; i < one.size(); ++i)
            if (!(std::abs(one[i] - two[i]) <= 1e-9 * (std::abs(one[i]) + std::abs(start[i]))))
                return false;
    }
    return true;
}

/// Returns, in the image mode, the transition whose event function is the image of the given transition's.
std::size_t image_of_transition(const System& system, std::size_t symmetry, std::size_t mode, std::size_t transition,
                                const Orbit& orbit) {
    const Model& model = system.model();
    const Function& own = system.event(model.transitions[transition].event);
    const std::vector<double> periods = system.periods()(orbit.parameters);
    for (const double turns : {0.0, -1.0, 1.0})
        for (std::size_t candidate = 0; candidate < model.transitions.size(); ++candidate)
            if (model.transitions[candidate].mode == mode &&
                is_image(own, system.event(model.transitions[candidate].event), system.symmetry(symmetry).map, orbit,
                         periods, turns) &&
                (!system.transition(transition).one_of_many ||
                 has_image_jump(system, symmetry, transition, candidate, orbit)))
                return candidate;
    throw InputError(
        fmt::format("the symmetry does not take transition '{}' to any other", model.transitions[transition].label),
        "see graze check for what is wrong with the symmetry");
}

} // namespace

Segment image_of(const System& system, std::size_t symmetry, const Segment& segment, const Orbit& orbit) {
    require_index(symmetry, system.model().symmetries.size(), "symmetry");
    require_index(segment.mode, system.model().modes.size(), "mode");
    end_name(system.model(), segment); // throws when the end does not exist
    Segment image = segment;
    image.mode = system.model().symmetries[symmetry].modes[segment.mode];
    if (ends_by_transition(segment))
        image.index = image_of_transition(system, symmetry, image.mode, segment.index, orbit);
    return image;
}

Orbit whole_orbit(const System& system, const Orbit& orbit) {
    validate_orbit(system.model(), orbit);
    if (!orbit.symmetry)
        return orbit;
    const Segment& last = orbit.signature.back();
    const bool smooth = std::ranges::all_of(
        orbit.signature, [&](const Segment& segment) { return segment == last && segment.end == SegmentEnd::section; });
    const Function& map = system.symmetry(*orbit.symmetry).map;
    Orbit whole = orbit;
    whole.symmetry.reset();
    for (std::size_t k = 0; k < orbit.segments(); ++k) {
        const Segment segment = image_of(system, *orbit.symmetry, orbit.signature[k], orbit);
        // The image of a section is not a section of the model: merge the two segments.
        if (k == 0 && !smooth && orbit.signature.back().end == SegmentEnd::section) {
            whole.signature.back() = segment;
            whole.durations.back() += orbit.durations[0];
            continue;
        }
        whole.signature.push_back(segment);
        whole.starts.push_back(map(concatenated(orbit.starts[k], orbit.parameters)));
        whole.durations.push_back(orbit.durations[k]);
    }
    return smooth ? cut_at_section(system, whole, last.index) : whole;
}

namespace {

/// Requires that an orbit which is homoclinic to a cycle begins and ends with the cycle's segments.
void validate_cycle(const Orbit& orbit) {
    const std::size_t count = *orbit.cycle;
    const Signature& all = orbit.signature;
    const auto some = static_cast<std::ptrdiff_t>(count);
    if (count == 0 || all.size() / 2 < count || !std::equal(all.begin(), all.begin() + some, all.end() - some))
        throw InputError(
            fmt::format("an orbit that is homoclinic to a cycle of {} segments does not begin and end with "
                        "these segments",
                        count),
            "let it turn once beside the cycle before it leaves it, and once after it has come back");
    if (orbit.symmetry || std::ranges::any_of(all, [](const Segment& one) { return one.end == SegmentEnd::chatter; }))
        throw InputError("an orbit that is homoclinic to a cycle is given whole, and without complete chatter",
                         "leave out its symmetry, and choose another cycle where contacts accumulate");
}

} // namespace

void validate_orbit(const Model& model, const Orbit& orbit) {
    if (orbit.symmetry && *orbit.symmetry >= model.symmetries.size())
        throw InputError("the orbit has a symmetry that the model does not have", "declare it in the model");
    validate_signature(model, orbit.signature, {}, orbit.symmetry);
    if (orbit.cycle)
        validate_cycle(orbit);
    if (orbit.parameters.size() != model.independent_parameters().size())
        throw InputError(fmt::format("the orbit has {} parameters and the model {}", orbit.parameters.size(),
                                     model.independent_parameters().size()),
                         "give one value for each independent parameter");
    if (orbit.starts.size() != orbit.segments() || orbit.durations.size() != orbit.segments())
        throw InputError(fmt::format("{} segments have {} starts and {} durations", orbit.segments(),
                                     orbit.starts.size(), orbit.durations.size()),
                         "give a start and a duration for each segment of the signature");
    for (std::size_t k = 0; k < orbit.segments(); ++k) {
        if (orbit.starts[k].size() != model.states.size())
            throw InputError(fmt::format("the start of segment {} has {} numbers", k + 1, orbit.starts[k].size()),
                             fmt::format("give the model's {} states", model.states.size()));
        for (const double value : orbit.starts[k])
            if (!std::isfinite(value))
                throw InputError(fmt::format("the start of segment {} is not finite", k + 1), "give finite numbers");
        if (!std::isfinite(orbit.durations[k]))
            throw InputError(fmt::format("the duration of segment {} is not finite", k + 1), "give a finite number");
    }
    for (const double value : orbit.parameters)
        if (!std::isfinite(value))
            throw InputError("a parameter of the orbit is not finite", "give finite numbers");
}

} // namespace graze
