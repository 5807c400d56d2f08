#include "graze/base/input_error.hpp"
#include "graze/grazing/trial.hpp"
#include "graze/results/touching_orbit.hpp"
#include "program/commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

namespace {

/// The orbit that touches, and what becomes of it.
struct GrazingFindings : TouchingOrbit, TouchReport {};

/// A table of facts: name, value, meaning.
class GrazingFacts {
public:
    GrazingFacts() : table_({{"quantity", ""}, {"value", ""}, {"meaning", ""}}) {}
    void add(const std::string& name, double value, const std::string& meaning) {
        table_.add(name, value, meaning);
        values_.add(name, value);
    }
    void add(const std::string& name, std::optional<double> value, const std::string& meaning) {
        if (value)
            add(name, *value, meaning);
    }
    void add(const std::string& name, std::string_view value, const std::string& meaning) {
        table_.add(name, value, meaning);
        values_.add(name, value);
    }
    const Table& table() const { return table_; }
    /// The same facts by name, without meanings.
    const JsonObject& values() const { return values_; }

private:
    Table table_;
    JsonObject values_;
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
OrderTexts texts_of(MapOrder order) {
    switch (order) {
    case MapOrder::square_root:
        return {"a rigid contact", "what it gains by approach speed", "the next order: by its square"};
    case MapOrder::linear:
        return {"sliding or sticking for a moment", "what it gains by depth", "the next order: by depth^(3/2)"};
    case MapOrder::three_halves:
    case MapOrder::none:
        break;
    }
    return {"a compliant contact", "what it gains by depth^(3/2)", ""};
}

/// Adds where and how the orbit touches.
void add_contact(GrazingFacts& facts, const Model& model, const CycleMap& map) {
    const DiscontinuityMap& contact = map.contact;
    facts.add("event", model.events[map.touch.event].name, "that is touched");
    if (!map.exists()) {
        facts.add("map", name_of(MapOrder::none), map.reason);
        return;
    }
    const OrderTexts texts = texts_of(contact.order);
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

void add_cycle(GrazingFacts& facts, const GrazingFindings& found) {
    const CycleMap& map = found.map;
    if (!map.exists() && !map.contact.ends)
        return;
    facts.add("cycle", map.time, map.half ? "its time (of half the orbit)" : "its time");
    if (!map.multipliers.empty())
        facts.add("multiplier", std::abs(map.multipliers.front()), "modulus of the largest one");
    for (std::size_t k = 0; k < found.verdict.projections.size(); ++k)
        facts.add(fmt::format("projection_{}", k + 1), found.verdict.projections[k],
                  k == 0 ? "effect on the gap one cycle later" : fmt::format("{} cycles later", k + 1));
    if (!map.second.empty())
        facts.add("projection_1_next", map.second_clearance,
                  map.contact.order == MapOrder::linear ? "next order of the first: by depth^(3/2)"
                                                        : "next order of the first: by speed^2");
    if (map.touches > 1)
        facts.add("touches", static_cast<double>(map.touches), "places in which the orbit touches");
    if (!found.parameter)
        return;
    facts.add("parameter", found.stored.run.model.independent_parameters()[found.parameter->place()],
              "moves the orbit from the touch");
    facts.add("clearance_rate", map.clearance_rate, "of the least gap by the parameter");
    facts.add("speed_factor", found.verdict.speed_factor, "speed of the first contact by distance^(1/2)");
    if (found.verdict.side != 0)
        facts.add("contacts_when", found.verdict.side > 0 ? "above" : "below", "the side of it with contacts");
}

/// Adds what the map settles on at some distances beyond the touch, where an attractor remains.
void add_attractors(GrazingFacts& facts, const GrazingFindings& found) {
    for (const MotionBeyond& one : found.beyond)
        facts.add(fmt::format("beyond_1e-{}", one.digits),
                  one.motion.period > 0 ? fmt::format("{} in {}", one.motion.contacts, one.motion.period) : "aperiodic",
                  fmt::format("contacts in cycles at {:.9g}", one.parameter));
}

/// Adds what becomes of an orbit that begins to slide.
void add_border(GrazingFacts& facts, const Verdict& verdict) {
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

void add_verdict(GrazingFacts& facts, const GrazingFindings& found) {
    const Verdict& verdict = found.verdict;
    const auto logarithm = [](const std::optional<double>& value) {
        return value ? std::optional(std::log10(*value)) : std::nullopt;
    };
    const auto meaning = [&]() -> std::string {
        switch (verdict.outcome) {
        case GrazingOutcome::persists:
            return "an attractor remains beside the touch";
        case GrazingOutcome::lost:
            return "no attractor remains: it trips";
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
    if (found.trial)
        facts.add("trial", name_of(found.trial->outcome), found.trial->reason);
}

JsonObject grazing_heading(const ResultFile& file, const GrazingFindings& found, const GrazingFacts& facts) {
    JsonObject heading = heading_of_point(file, found.stored);
    heading.add("reason", found.verdict.reason);
    heading.add("values", facts.values());
    std::vector<JsonObject> motions;
    if (found.trial)
        for (const TrialMotion& motion : found.trial->motions) {
            JsonObject& one = motions.emplace_back();
            one.add("parameter", motion.parameter);
            one.add("clearance", motion.clearance);
            one.add("predicted", motion.predicted);
            one.add("largest", motion.largest);
            one.add("contacts", static_cast<double>(motion.contacts));
            one.add("ended", motion.ended ? 1.0 : 0.0);
        }
    heading.add("trial_motions", motions);
    return heading;
}

} // namespace

int grazing_command(const GrazingArguments& arguments, const Console& console) {
    const ResultFile file(result_path(arguments.file), ResultFile::Access::read);
    TouchingOrbit orbit =
        find_touching_orbit(file, arguments.point, arguments.parameter, {"POINT", 0, 0}, {"--parameter", 0, 0});
    TouchReport report = touch_report(System(orbit.stored.run.model), orbit.map, orbit.parameter, arguments.verify);
    const GrazingFindings found{std::move(orbit), std::move(report)};
    GrazingFacts facts;
    add_contact(facts, found.stored.run.model, found.map);
    add_cycle(facts, found);
    add_verdict(facts, found);
    deliver(facts.table(), arguments.output, grazing_heading(file, found, facts), console);
    const bool contradicted = found.trial && found.trial->outcome == TrialOutcome::contradicted;
    return contradicted ? exit_irregular : exit_success;
}

} // namespace graze
