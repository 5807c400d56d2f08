#include "model/corner_modes.hpp"

#include "model/model_completion.hpp"

#include <fmt/format.h>

#include <set>

namespace graze {

namespace {

/// Returns the map that puts a state close to the zeros of both functions onto them: a step of Newton's method along
/// their gradients.
StateMap projection_onto(const std::vector<Expression>& states, const std::array<Expression, 2>& functions) {
    std::array<std::vector<Expression>, 2> gradients;
    for (std::size_t i = 0; i < 2; ++i)
        gradients[i] = jacobian({&functions[i], 1}, states);
    const auto product = [&](std::size_t i, std::size_t j) {
        Expression sum = gradients[i][0] * gradients[j][0];
        for (std::size_t k = 1; k < states.size(); ++k)
            sum = sum + gradients[i][k] * gradients[j][k];
        return sum;
    };
    const Expression one = product(0, 0), mixed = product(0, 1), other = product(1, 1),
                     determinant = one * other - mixed * mixed,
                     first = (other * functions[0] - mixed * functions[1]) / determinant,
                     second = (one * functions[1] - mixed * functions[0]) / determinant;
    StateMap map(states);
    for (std::size_t k = 0; k < states.size(); ++k)
        if (!gradients[0][k].is_number(0) || !gradients[1][k].is_number(0))
            map[k] = states[k] - (first * gradients[0][k] + second * gradients[1][k]);
    return map;
}

} // namespace

/// From now on states that follow from the others on both surfaces are replaced.
void CornerModes::enter(const SlideCorner& corner) {
    motion_.leave_surfaces();
    for (const CornerSurface& surface : corner.surfaces) {
        const Slide& slide = model_.slides[surface.above];
        const std::vector<Expression> left = motion_.expanded(model_.modes[slide.left].rates),
                                      right = motion_.expanded(model_.modes[slide.right].rates);
        motion_.add_surface(motion_.expanded(model_.events[slide.surface].function), differing(left, right));
    }
}

CornerModes::Arms CornerModes::arms_of(const SlideCorner& corner) {
    Arms arms;
    for (std::size_t i = 0; i < arms.size(); ++i) {
        Arm& arm = arms[i];
        const CornerSurface &own = corner.surfaces[i / 2], &crossing = corner.surfaces[1 - i / 2];
        arm.above = i % 2 == 1;
        arm.slide = arm.above ? own.above : own.below;
        arm.mode = *model_.find_mode(slide_of(arm).name);
        arm.other = model_.slides[crossing.above].surface;
        const Expression function = motion_.expanded(model_.events[slide_of(arm).surface].function),
                         other = motion_.expanded(model_.events[arm.other].function);
        const auto rate = [&](const Expression& of, std::size_t mode) {
            return motion_.on_surface(motion_.rate_along(of, motion_.expanded(model_.modes[mode].rates)));
        };
        arm.from_left = rate(function, slide_of(arm).left);
        arm.from_right = -rate(function, slide_of(arm).right);
        arm.towards = arm.above ? -rate(other, arm.mode) : rate(other, arm.mode);
    }
    return arms;
}

std::size_t CornerModes::jump_onto(const SlideCorner& corner) {
    std::array<Expression, 2> functions;
    std::array<std::string, 2> names;
    for (std::size_t i = 0; i < 2; ++i) {
        const Event& event = model_.events[model_.slides[corner.surfaces[i].above].surface];
        functions[i] = motion_.expanded(event.function);
        names[i] = event.name;
    }
    const std::vector<Expression> states = model_.state_symbols(), images = motion_.on_surface(states);
    StateMap exact(states);
    for (std::size_t i = 0; i < states.size(); ++i)
        if (!(images[i] == states[i]))
            exact[i] = images[i];
    const bool both = motion_.on_surface(functions[0]).is_number(0) && motion_.on_surface(functions[1]).is_number(0);
    return derived_jump(
        model_, places_, "slides." + model_.slides[corner.surfaces[0].above].name,
        {.name = fmt::format("onto-{}-{}", names[0], names[1]),
         .text = fmt::format("the state is put onto the surfaces of '{}' and '{}' exactly", names[0], names[1]),
         .map = both ? exact : projection_onto(states, functions)});
}

void CornerModes::add_ways(const SlideCorner& corner) {
    enter(corner);
    const Arms arms = arms_of(corner);
    const std::size_t jump = jump_onto(corner);
    for (std::size_t from = 0; from < arms.size(); ++from)
        add_ways_from(corner, arms, from, jump);
}

/// Adds the transition of a motion along one surface that meets the other.
void CornerModes::add_ways_from(const SlideCorner& corner, const Arms& arms, std::size_t from, std::size_t jump) {
    const Arm &arm = arms[from], &beyond = arms[from ^ 1U], &below = arms[2 - (from & 2U)],
              &above = arms[3 - (from & 2U)];
    const std::size_t event = arm.above ? arm.other : *model_.find_event(events_.rising_name(slide_of(below)));
    if (model_.find_transition(arm.mode, event) != nullptr)
        return; // the user's
    Transition way{.label = mode_name(arm.mode) + ":" + model_.events[event].name,
                   .mode = arm.mode,
                   .event = event,
                   .jump = jump,
                   .derived = true};
    const auto add = [&](std::vector<Condition> base, std::vector<Condition> conditions, const char* text,
                         std::size_t mode) {
        base.insert(base.end(), conditions.begin(), conditions.end());
        way.next.push_back({std::move(base), text, mode});
    };
    const auto add_slide = [&](const std::vector<Condition>& base, const Arm& next) {
        add(base, {{next.from_left, false}, {next.from_right, false}, {-next.towards, true}}, "slides on", next.mode);
    };
    // A field with its side of the other surface leaves both.
    const auto add_sides = [&](const std::vector<Condition>& base) {
        add(base, {{-beyond.from_left, true}, {beyond.above ? -below.from_right : -below.from_left, true}},
            "leaves both", slide_of(beyond).left);
        add(base, {{-beyond.from_right, true}, {beyond.above ? -above.from_right : -above.from_left, true}},
            "leaves both", slide_of(beyond).right);
    };
    const Expression other_attracts = below.from_left + below.from_right;
    const std::vector<Condition> both_attract{{other_attracts, true}, {arm.towards + beyond.towards, true}},
        one_attracts{{-other_attracts, false}};
    std::vector<Condition> all_push;
    for (const Arm& one : arms)
        all_push.push_back({one.towards, false});
    add(both_attract, all_push, "all push back", *model_.find_mode(corner.name));
    for (const Arm* const next : {&beyond, &below, &above})
        add_slide(both_attract, *next);
    add_sides(both_attract);
    add_slide(one_attracts, beyond);
    add_sides(one_attracts);
    way.otherwise =
        fmt::format("sliding meets the surface of '{}', of another slide, and how the motion goes on is not "
                    "unique: add [[transitions]] with mode = \"{}\" and event = \"{}\"",
                    model_.events[arm.other].name, mode_name(arm.mode), model_.events[event].name);
    model_.transitions.push_back(std::move(way));
}

/// Adds the end of sliding along both surfaces where one of the motions along one no longer pushes towards the other.
std::size_t CornerModes::add_exit(const SlideCorner& corner, const Arm& arm, std::size_t jump) {
    const std::size_t event = derived_event(
        model_, places_, "slides." + slide_of(arm).name,
        {.name = fmt::format("{}-{}", corner.name, mode_name(arm.mode)),
         .text = fmt::format("'{}' no longer pushes towards '{}'", mode_name(arm.mode), model_.events[arm.other].name),
         .function = arm.towards});
    model_.transitions.push_back({.label = fmt::format("{}:{}", corner.name, mode_name(arm.mode)),
                                  .mode = *model_.find_mode(corner.name),
                                  .event = event,
                                  .jump = jump,
                                  .next = {{.mode = arm.mode}},
                                  .derived = true});
    return event;
}

void CornerModes::complete(const SlideCorner& corner) {
    enter(corner);
    const Arms arms = arms_of(corner);
    const Arm &below = arms[0], &above = arms[1];
    const std::size_t sliding = *model_.find_mode(corner.name);
    const Expression share = below.towards / (below.towards + above.towards);
    const std::vector<Expression> first = motion_.expanded(model_.modes[below.mode].rates),
                                  second = motion_.expanded(model_.modes[above.mode].rates);
    model_.modes[sliding].rates = motion_.tangent(combined(first, second, share));

    const std::vector<Expression>& rates = model_.modes[sliding].rates;
    const auto stays = [&](const Arm& arm) {
        return motion_.stays(motion_.expanded(model_.events[slide_of(arm).surface].function), rates);
    };
    const std::size_t jump = stays(arms[0]) && stays(arms[2]) ? 0 : jump_onto(corner);
    std::set<std::size_t> known;
    for (std::size_t surface = 0; surface < 2; ++surface) {
        const Arm &own = arms[2 * surface], &crossing = arms[2 - 2 * surface];
        SlidingSurface along{.surface = slide_of(own).surface};
        along.exits = {add_exit(corner, crossing, jump), add_exit(corner, arms[3 - 2 * surface], jump)};
        model_.modes[sliding].slides_on.push_back(along);
        known.insert({along.surface, *model_.find_event(events_.rising_name(slide_of(own)))});
    }
    for (const Arm& arm : arms)
        for (const SlidingSurface& one : model_.modes[arm.mode].slides_on)
            known.insert(one.exits.begin(), one.exits.end());
    events_.watch_at_corner(
        {.name = corner.name, .surface = slide_of(arms[2]).surface, .left = below.mode, .right = above.mode}, known);
}

} // namespace graze
