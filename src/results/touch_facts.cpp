#include "graze/results/touch_facts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

namespace {

/// Rows of a table: name, value, meaning.
class TouchRows {
public:
    void add(const std::string& name, double value, const std::string& meaning) { table.add(name, value, meaning); }
    void add(const std::string& name, std::optional<double> value, const std::string& meaning) {
        if (value)
            add(name, *value, meaning);
    }
    void add(const std::string& name, std::string_view value, const std::string& meaning) {
        table.add(name, value, meaning);
    }
    Table table{{{"quantity", ""}, {"value", ""}, {"meaning", ""}}};
};

std::string contacts_text(const Model& model, const std::vector<std::size_t>& contacts) {
    std::vector<std::string> labels;
    for (const std::size_t contact : contacts)
        labels.push_back(model.transitions[contact].label);
    return fmt::format("{}", fmt::join(labels, " "));
}

struct OrderTexts {
    const char *contact, *gain, *next;
};
OrderTexts order_texts(MapOrder order) {
    switch (order) {
    case MapOrder::square_root:
        return {"a rigid contact", "what it gains by approach speed", "the next order: by its square"};
    case MapOrder::linear:
        return {"sliding or sticking for a moment", "what it gains by depth", "the next order: by depth^(3/2)"};
    case MapOrder::quadratic:
        return {"sliding that is left for a moment", "what it gains by depth^2", ""};
    case MapOrder::three_halves:
    case MapOrder::none:
        break;
    }
    return {"a compliant contact", "what it gains by depth^(3/2)", ""};
}

/// The orbit that touches, and what becomes of it.
struct Touched {
    const TouchingOrbit& orbit;
    const TouchReport& report;
};

/// Adds where and how the orbit touches.
void add_contact(TouchRows& facts, const Model& model, const CycleMap& map) {
    const DiscontinuityMap& contact = map.contact;
    facts.add("event", model.events[map.touch.event].name, "that is touched");
    if (!map.exists()) {
        facts.add("map", name_of(MapOrder::none), map.reason);
        return;
    }
    const OrderTexts texts = order_texts(contact.order);
    facts.add("map", name_of(contact.order), texts.contact);
    facts.add("contacts", contacts_text(model, contact.contacts), "transitions that a soft contact makes");
    facts.add("acceleration", contact.acceleration, "second rate of the gap (the event's function)");
    if (contact.order == MapOrder::square_root)
        facts.add("restitution", contact.restitution, "rate of the gap after by that before");
    for (std::size_t i = 0; i < contact.direction.size(); ++i)
        if (contact.direction[i] != 0)
            facts.add("direction_" + model.states[i].name, contact.direction[i], texts.gain);
    for (std::size_t i = 0; i < contact.second.size(); ++i)
        if (contact.second[i] != 0)
            facts.add("second_" + model.states[i].name, contact.second[i], texts.next);
}

void add_cycle(TouchRows& facts, const Touched& found) {
    const CycleMap& map = found.orbit.map;
    if (!map.exists() && !map.contact.ends)
        return;
    facts.add("cycle", map.time, map.half ? "its time (of half the orbit)" : "its time");
    if (!map.multipliers.empty())
        facts.add("multiplier", std::abs(map.multipliers.front()), "modulus of the largest one");
    for (std::size_t k = 0; k < found.report.verdict.projections.size(); ++k)
        facts.add(fmt::format("projection_{}", k + 1), found.report.verdict.projections[k],
                  k == 0 ? "effect on the gap one cycle later" : fmt::format("{} cycles later", k + 1));
    if (!map.second.empty())
        facts.add("projection_1_next", map.second_clearance,
                  map.contact.order == MapOrder::linear ? "next order of the first: by depth^(3/2)"
                                                        : "next order of the first: by speed^2");
    if (map.touches > 1)
        facts.add("touches", static_cast<double>(map.touches), "places in which the orbit touches");
    if (!found.orbit.parameter)
        return;
    facts.add("parameter", found.orbit.stored.run.model.independent_parameters()[found.orbit.parameter->place()],
              "moves the orbit from the touch");
    facts.add("clearance_rate", map.clearance_rate, "of the least gap by the parameter");
    facts.add("speed_factor", found.report.verdict.speed_factor, "speed of the first contact by distance^(1/2)");
    if (found.report.verdict.side != 0)
        facts.add("contacts_when", found.report.verdict.side > 0 ? "above" : "below", "the side of it with contacts");
}

/// Adds what the map settles on at some distances beyond the touch, where an attractor remains.
void add_attractors(TouchRows& facts, const Touched& found) {
    for (const MotionBeyond& one : found.report.beyond)
        facts.add(fmt::format("beyond_1e-{}", one.digits),
                  one.motion.period > 0 ? fmt::format("{} in {}", one.motion.contacts, one.motion.period) : "aperiodic",
                  fmt::format("contacts in cycles at {:.9g}", one.parameter));
}

/// Adds what becomes of an orbit that begins to slide.
void add_border(TouchRows& facts, const Verdict& verdict) {
    if (verdict.border == BorderCollision::none)
        return;
    facts.add("border", name_of(verdict.border),
              verdict.border == BorderCollision::fold ? "the orbit that slides is on the same side as the touching one"
                                                      : "beyond the touch the orbit slides");
    if (verdict.doubles)
        facts.add("doubles", "yes", "an orbit of twice the period begins here");
    if (verdict.in > 0)
        facts.add("beyond", fmt::format("{} in {}", verdict.slides, verdict.in), "times it slides in cycles");
}

void add_verdict(TouchRows& facts, const Touched& found) {
    const Verdict& verdict = found.report.verdict;
    const auto logarithm = [](const std::optional<double>& value) {
        return value ? std::optional(std::log10(*value)) : std::nullopt;
    };
    const auto meaning = [&]() -> std::string {
        switch (verdict.outcome) {
        case GrazingOutcome::persists:
            return "an attractor remains beside the touch";
        case GrazingOutcome::lost:
            return "no attractor remains near the grazing orbit";
        case GrazingOutcome::folds:
            return "the orbit remains up to a fold";
        case GrazingOutcome::undecided:
            break;
        }
        return verdict.reason;
    }();
    facts.add("verdict", name_of(verdict.outcome), meaning);
    if (verdict.attractor != AttractorKind::none)
        facts.add("attractors", name_of(verdict.attractor), "that remain");
    facts.add("leading", verdict.leading,
              verdict.border == BorderCollision::none ? "multiplier that decides which"
                                                      : "modulus of its largest multiplier where it slides");
    add_border(facts, verdict);
    add_attractors(facts, found);
    if (verdict.next_contact > 0)
        facts.add("next_contact", static_cast<double>(verdict.next_contact), "n: cycles from one contact to the next");
    facts.add("growth", verdict.growth, "next approach speed by speed^(1/2)");
    facts.add("log10_growth", logarithm(verdict.growth), "");
    facts.add("jump_growth", verdict.jump_growth, "c: next jump of the rate by jump^(1/2)");
    facts.add("log10_jump_growth", logarithm(verdict.jump_growth), "");
    facts.add("reach", verdict.reach, "speed up to which contacts would grow");
    facts.add("alpha", verdict.alpha, "of the cubic alpha tau^3 + tau^2 + gap");
    facts.add("fold_clearance", verdict.fold_clearance, "least gap without contact where it turns");
    facts.add("fold_depth", verdict.fold_depth, "depth of the contact there");
    facts.add("fold_distance", verdict.fold_distance, "of the parameter from the touch");
    facts.add("unstable_depth", verdict.unstable_depth, "depth at which it loses stability before");
    if (found.report.trial)
        facts.add("trial", name_of(found.report.trial->outcome), found.report.trial->reason);
}

} // namespace

Table touch_facts(const TouchingOrbit& orbit, const TouchReport& report) {
    TouchRows facts;
    add_contact(facts, orbit.stored.run.model, orbit.map);
    add_cycle(facts, {orbit, report});
    add_verdict(facts, {orbit, report});
    return facts.table;
}

} // namespace graze
