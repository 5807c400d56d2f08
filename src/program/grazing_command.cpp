#include "graze/grazing/trial.hpp"
#include "graze/results/stored_orbit.hpp"
#include "graze/symbolic/input_error.hpp"
#include "program/commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace graze {

namespace {

/// What has been found at a point.
struct Findings {
    StoredOrbit stored;
    std::optional<ParameterId> parameter;
    CycleMap map;
    Verdict verdict;
    std::optional<Trial> trial;
};

/// Rows of what is known: a name, a value, what it is.
class Facts {
public:
    Facts() : table_({{"quantity", ""}, {"value", ""}, {"meaning", ""}}) {}
    void add(const std::string& name, double value, const std::string& meaning) {
        table_.add(name);
        table_.add(value);
        table_.add(meaning);
        values_.add(name, value);
    }
    void add(const std::string& name, std::optional<double> value, const std::string& meaning) {
        if (value)
            add(name, *value, meaning);
    }
    void add(const std::string& name, std::string_view value, const std::string& meaning) {
        table_.add(name);
        table_.add(value);
        table_.add(meaning);
        values_.add(name, value);
    }
    const Table& table() const { return table_; }
    /// The same by name, without meanings.
    const JsonObject& values() const { return values_; }

private:
    Table table_;
    JsonObject values_;
};

/// What moves the orbit from its touch: what was asked for, or what the run follows. On a curve that is first the one
/// that has been freed, since its own may have nothing to do with the orbit, as the stiffness of a stop has not.
std::vector<ParameterId> parameters_of(const StoredRun& run, const std::string& asked) {
    if (!asked.empty())
        return {run.model.independent_parameter(asked)};
    std::vector<ParameterId> result;
    if (run.record.kind == "curve" && run.record.coordinates.size() > 1)
        result.push_back(run.model.independent_parameter(run.record.coordinates[1].name));
    if (const std::string followed = followed_parameter(run.record); !followed.empty())
        result.push_back(run.model.independent_parameter(followed));
    return result;
}

/// A grazing is kept with its place; others are looked through for one.
OrbitTouch touch_of(const System& system, const OrbitRecord& record) {
    const SpecialPoint& point = record.point;
    if (point.type == PointType::grazing)
        return {point.segment, point.event, point.time, point.at_end};
    const std::vector<OrbitTouch> touches = touches_of(system, point.solution.orbit);
    if (touches.empty())
        throw InputError(Place{"POINT", 0, 0}, fmt::format("the orbit at {} touches nothing", title_of(record)),
                         "choose a grazing (GR), or a point of a curve of them");
    return touches.front();
}

/// The map with the first of the parameters that moves the orbit; if none does, with the last.
void find_map(Findings& found, const System& system, const std::string& asked) {
    const OrbitTouch touch = touch_of(system, found.stored.record);
    CycleMapOptions options;
    found.map = cycle_map(system, found.stored.record.point.solution.orbit, touch, options);
    for (const ParameterId parameter : parameters_of(found.stored.run, asked)) {
        found.parameter = options.parameter = parameter;
        found.map = cycle_map(system, found.stored.record.point.solution.orbit, touch, options);
        if (found.map.clearance_rate && *found.map.clearance_rate != 0)
            return;
    }
}

std::string contacts_text(const Model& model, const std::vector<std::size_t>& contacts) {
    std::vector<std::string> labels;
    for (const std::size_t contact : contacts)
        labels.push_back(model.transitions[contact].label);
    return fmt::format("{}", fmt::join(labels, " "));
}

/// Where and how the orbit touches.
void add_contact(Facts& facts, const Model& model, const CycleMap& map) {
    const DiscontinuityMap& contact = map.contact;
    facts.add("event", model.events[map.touch.event].name, "that is touched");
    if (!map.exists()) {
        facts.add("map", name_of(MapOrder::none), map.reason);
        return;
    }
    const bool rigid = contact.order == MapOrder::square_root;
    facts.add("map", name_of(contact.order), rigid ? "a rigid contact" : "a compliant contact");
    facts.add("contacts", contacts_text(model, contact.contacts), "transitions that a soft contact makes");
    facts.add("acceleration", contact.acceleration, "second rate of the gap (the event's function)");
    if (rigid)
        facts.add("restitution", contact.restitution, "rate of the gap after by that before");
    for (std::size_t i = 0; i < contact.direction.size(); ++i)
        if (contact.direction[i] != 0)
            facts.add("direction_" + model.states[i].name, contact.direction[i],
                      rigid ? "what it gains by approach speed" : "what it gains by depth^(3/2)");
}

void add_cycle(Facts& facts, const Findings& found) {
    const CycleMap& map = found.map;
    if (!map.exists())
        return;
    facts.add("cycle", map.time, map.half ? "its time (of half the orbit)" : "its time");
    if (!map.multipliers.empty())
        facts.add("multiplier", std::abs(map.multipliers.front()), "modulus of the largest one");
    for (std::size_t k = 0; k < found.verdict.projections.size(); ++k)
        facts.add(fmt::format("projection_{}", k + 1), found.verdict.projections[k],
                  k == 0 ? "effect on the gap one cycle later" : fmt::format("{} cycles later", k + 1));
    if (map.touches > 1)
        facts.add("touches", static_cast<double>(map.touches), "places in which the orbit touches");
    if (!found.parameter)
        return;
    facts.add("parameter", found.stored.run.model.independent_parameters()[found.parameter->place()],
              "moves the orbit from the touch");
    facts.add("clearance_rate", map.clearance_rate, "of the least gap by the parameter");
    facts.add("first_speed", found.verdict.first_speed, "of the first contact by distance^(1/2)");
    if (found.verdict.side != 0)
        facts.add("contacts_when", found.verdict.side > 0 ? "above" : "below", "the side of it with contacts");
}

void add_verdict(Facts& facts, const Findings& found) {
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
    facts.add("leading", verdict.leading, "multiplier that decides which");
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

JsonObject heading_of(const ResultFile& file, const Findings& found, const Facts& facts) {
    const OrbitRecord& record = found.stored.record;
    JsonObject heading;
    heading.add("graze", GRAZE_VERSION);
    heading.add("file", file.path());
    heading.add("model", found.stored.run.model.name);
    heading.add("run", found.stored.run.record.name);
    heading.add("number", static_cast<double>(record.number));
    heading.add("label", record.label);
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
    Findings found{find_stored_orbit(file, arguments.point, {"POINT", 0, 0}), {}, {}, {}, {}};
    const System system(found.stored.run.model);
    find_map(found, system, arguments.parameter);
    found.verdict = verdict_of(found.map);
    if (arguments.verify) {
        if (!found.parameter)
            throw InputError("nothing is said to move the orbit from its touch",
                             "name a parameter by --parameter NAME");
        found.trial = try_verdict(system, found.map, found.verdict, *found.parameter);
    }
    Facts facts;
    add_contact(facts, found.stored.run.model, found.map);
    add_cycle(facts, found);
    add_verdict(facts, found);
    deliver(facts.table(), arguments.output, heading_of(file, found, facts), console);
    const bool contradicted = found.trial && found.trial->outcome == TrialOutcome::contradicted;
    return contradicted ? exit_irregular : exit_success;
}

} // namespace graze
