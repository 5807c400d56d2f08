// Dry friction: each mode in whose rates a friction stands becomes modes for both directions and for rest. At rest the
// friction is the force that keeps the velocity at zero, so that the motion is the sliding motion on that surface; with
// several frictions at rest all of these forces follow from linear equations.

#include "model/friction_modes.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/transform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace graze {

FrictionModes::FrictionModes(Model& model, const Places& places, const std::vector<RubbingMode>& rubbing)
    : model_(model), places_(places), rubbing_(rubbing), expander_(model), motion_(model, expander_) {
    for (const Friction& friction : model_.frictions)
        add_law(friction);
    for (std::size_t i = 0; i < laws_.size(); ++i)
        require_use(i);
    for (const RubbingMode& one : rubbing_)
        add_variants(one);
}

const RubbingMode* FrictionModes::rubbing(std::size_t mode) const {
    const auto found = std::ranges::find(rubbing_, mode, &RubbingMode::mode);
    return found == rubbing_.end() ? nullptr : &*found;
}

const FrictionVariant& FrictionModes::variant(std::size_t mode, const FrictionStates& states) const {
    std::vector<FrictionState> wanted;
    for (const auto& [law, state] : states)
        wanted.push_back(state);
    return *std::ranges::find(variants_.at(mode), wanted, &FrictionVariant::states);
}

FrictionStates FrictionModes::states_of(const RubbingMode& rubbing, const FrictionVariant& variant) const {
    FrictionStates states;
    for (std::size_t i = 0; i < rubbing.frictions.size(); ++i)
        states[rubbing.frictions[i]] = variant.states[i];
    return states;
}

bool FrictionModes::stays(const FrictionVariant& variant, std::size_t law) const {
    return motion_.stays(laws_[law].velocity, model_.modes[variant.mode].rates);
}

/// Returns whether a jump leaves a velocity as it is.
bool FrictionModes::keeps(std::size_t jump, std::size_t law) {
    const StateMap& map = model_.jumps[jump].map;
    if (map.empty())
        return true;
    const std::vector<Expression> states = model_.state_symbols(),
                                  images = motion_.expanded(std::vector<Expression>(map));
    std::vector<Replacement> replacements;
    for (std::size_t i = 0; i < states.size(); ++i)
        replacements.emplace_back(states[i], images[i]);
    const Expression& velocity = laws_[law].velocity;
    return substitute(velocity, replacements) == velocity;
}

void FrictionModes::add_law(const Friction& friction) {
    FrictionLaw law{.name = friction.name, .path = "friction." + friction.name, .symbol = model_.symbol(friction.name)};
    law.velocity = motion_.expanded(friction.velocity);
    const Expression sliding = motion_.expanded(friction.coefficient * friction.normal);
    law.limit = motion_.expanded(friction.static_coefficient.value_or(friction.coefficient) * friction.normal);
    if (!motion_.depends_on_states(law.velocity))
        throw InputError(places_.of(law.path + ".velocity"),
                         fmt::format("the velocity of the friction '{}' does not depend on a state", law.name),
                         "give the velocity of one body relative to the other");
    const std::vector<double> values = values_at_start(model_, std::vector<Expression>{sliding, law.limit});
    if (!values.empty() && values[1] < values[0])
        throw InputError(
            places_.of(law.path + ".static"),
            fmt::format("static friction of '{}' is {} in the initial state, less than dynamic friction, {}", law.name,
                        values[1], values[0]),
            "give a static coefficient that is not less than the coefficient");
    law.stops_forward = derived_event(
        model_, places_, law.path,
        {.name = law.name + "-stops-forward", .text = "motion forward comes to an end", .function = friction.velocity});
    law.stops_backward = derived_event(model_, places_, law.path,
                                       {.name = law.name + "-stops-backward",
                                        .text = "motion backward comes to an end",
                                        .function = -friction.velocity});
    law.stop = derived_jump(model_, places_, law.path,
                            {.name = law.name + "-stop",
                             .text = "the velocity is set to zero exactly",
                             .map = motion_.projection(law.velocity)});
    laws_.push_back(std::move(law));
}

/// Every friction must have a use.
void FrictionModes::require_use(std::size_t law) const {
    if (std::ranges::none_of(rubbing_, [&](const RubbingMode& one) {
            return std::ranges::find(one.frictions, law) != one.frictions.end();
        }))
        throw InputError(places_.of(laws_[law].path),
                         fmt::format("no mode has the friction '{}' in its rates", laws_[law].name),
                         fmt::format("write the force in the rates of a mode, as in (drive - {})/m", laws_[law].name));
}

void FrictionModes::add_variants(const RubbingMode& rubbing) {
    std::vector<FrictionVariant>& variants = variants_[rubbing.mode];
    std::vector<std::pair<std::vector<FrictionState>, std::string>> made{{{}, model_.modes[rubbing.mode].name}};
    for (std::size_t i = 0; i < rubbing.frictions.size(); ++i) {
        std::vector<std::pair<std::vector<FrictionState>, std::string>> longer;
        for (const auto& one : made)
            for (std::size_t d = 0; d < friction_words.size(); ++d) {
                longer.push_back(one);
                longer.back().first.push_back(FrictionState(d));
                longer.back().second += fmt::format("-{}", friction_words[d]);
            }
        made = std::move(longer);
    }
    for (const auto& one : made) {
        FrictionVariant variant{.mode = *model_.find_mode(one.second), .states = one.first};
        Mode& mode = model_.modes[variant.mode];
        mode.text = model_.modes[rubbing.mode].text;
        mode.watched = model_.modes[rubbing.mode].watched;
        mode.rates = rates_of(rubbing, variant);
        variants.push_back(std::move(variant));
    }
}

/// Returns the rates of a variant, and sets its forces and accelerations.
std::vector<Expression> FrictionModes::rates_of(const RubbingMode& rubbing, FrictionVariant& variant) {
    std::vector<Replacement> forces;
    std::vector<std::size_t> at_rest;
    for (std::size_t i = 0; i < rubbing.frictions.size(); ++i) {
        const FrictionLaw& law = laws_[rubbing.frictions[i]];
        const Friction& friction = model_.frictions[rubbing.frictions[i]];
        const Expression force = friction.coefficient * friction.normal;
        if (variant.states[i] == FrictionState::stick)
            at_rest.push_back(rubbing.frictions[i]);
        else
            forces.emplace_back(law.symbol, variant.states[i] == FrictionState::forward ? force : -force);
    }
    std::vector<Expression> rates = substitute(model_.modes[rubbing.mode].rates, forces);
    motion_.leave_surfaces();
    if (!at_rest.empty())
        rates = rates_at_rest(rubbing, variant, at_rest, motion_.expanded(rates));
    if (rubbing.frictions.size() > 1) {
        const std::vector<Expression> field = motion_.expanded(rates);
        for (const std::size_t law : rubbing.frictions)
            variant.acceleration[law] = motion_.on_surface(motion_.rate_along(laws_[law].velocity, field));
    }
    return rates;
}

/// Solves for the forces that keep velocities at zero, one after another.
std::vector<Expression> FrictionModes::rates_at_rest(const RubbingMode& rubbing, FrictionVariant& variant,
                                                     const std::vector<std::size_t>& at_rest,
                                                     std::vector<Expression> field) {
    std::vector<bool> rubbed;
    for (const Expression& rate : field)
        rubbed.push_back(
            std::ranges::any_of(at_rest, [&](std::size_t law) { return contains_symbol(rate, laws_[law].symbol); }));
    for (const std::size_t law : at_rest)
        motion_.add_surface(laws_[law].velocity, rubbed);
    for (const std::size_t i : at_rest) {
        const FrictionLaw& law = laws_[i];
        const Expression rate = motion_.rate_along(law.velocity, field);
        const std::vector<Replacement> solved{{law.symbol, force_at_rest(rubbing, law, rate)}};
        field = substitute(field, solved);
        for (auto& force : variant.force)
            force.second = substitute(force.second, solved);
        variant.force[i] = solved.front().second;
    }
    for (auto& force : variant.force)
        force.second = motion_.on_surface(force.second);
    return motion_.tangent(std::move(field));
}

/// Returns the force at which a rate of a velocity is zero.
Expression FrictionModes::force_at_rest(const RubbingMode& rubbing, const FrictionLaw& law,
                                        const Expression& rate) const {
    const Expression slope = differentiate(rate, law.symbol);
    const std::string path = "modes." + model_.modes[rubbing.mode].name + ".rates";
    if (slope.is_number(0))
        throw InputError(places_.of(path),
                         fmt::format("the friction '{}' in mode '{}' has no effect on the rate of its velocity",
                                     law.name, model_.modes[rubbing.mode].name),
                         "write it in the rate of the velocity that the friction acts against");
    if (contains_symbol(slope, law.symbol))
        throw InputError(places_.of(path),
                         fmt::format("the rates of mode '{}' are not linear in the friction '{}'",
                                     model_.modes[rubbing.mode].name, law.name),
                         "write the force as a summand, as in (drive - friction)/m");
    const std::vector<double> value = values_at_start(model_, std::vector<Expression>{slope});
    if (!value.empty() && value.front() > 0)
        throw InputError(places_.of(path),
                         fmt::format("in mode '{}' the friction '{}' accelerates its velocity",
                                     model_.modes[rubbing.mode].name, law.name),
                         fmt::format("write -{}: a friction is the force against a positive velocity", law.name));
    const Expression rest = substitute(rate, std::vector<Replacement>{{law.symbol, model_.number(0)}});
    return slope.is_number(-1) ? rest : -rest / slope;
}

} // namespace graze
