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
    }
    void add(const std::string& name, std::optional<double> value, const std::string& meaning) {
        if (value)
            add(name, *value, meaning);
    }
    void add(const std::string& name, std::string_view value, const std::string& meaning) {
        if (value.empty())
            return;
        table_.add(name);
        table_.add(value);
        table_.add(meaning);
    }
    const Table& table() const { return table_; }

private:
    Table table_;
};

std::optional<ParameterId> parameter_of(const StoredRun& run, const std::string& asked) {
    const std::string name = asked.empty() ? followed_parameter(run.record) : asked;
    if (name.empty())
        return std::nullopt;
    return run.model.independent_parameter(name);
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
    facts.add("map", name_of(contact.order), "square-root: a rigid contact; three-halves: a compliant one");
    facts.add("no_map", map.reason, "why there is none");
    if (!map.exists())
        return;
    facts.add("contacts", contacts_text(model, contact.contacts), "transitions that a contact beside it makes");
    facts.add("acceleration", contact.acceleration, "second rate of the event's function at the touch");
    if (contact.order == MapOrder::square_root)
        facts.add("restitution", contact.restitution, "rate of the event's function after by that before");
    for (std::size_t i = 0; i < contact.direction.size(); ++i)
        if (contact.direction[i] != 0)
            facts.add("direction_" + model.states[i].name, contact.direction[i],
                      contact.order == MapOrder::square_root ? "what the state gains by approach speed"
                                                             : "what the state gains by the power 3/2 of the depth");
}

void add_cycle(Facts& facts, const Findings& found) {
    const CycleMap& map = found.map;
    if (!map.exists())
        return;
    facts.add("cycle", map.time, map.half ? "time of a cycle, the half of the orbit" : "time of a cycle");
    if (!map.multipliers.empty())
        facts.add("multiplier", std::abs(map.multipliers.front()), "modulus of the largest one");
    for (std::size_t k = 0; k < found.verdict.projections.size(); ++k)
        facts.add(fmt::format("projection_{}", k + 1), found.verdict.projections[k],
                  k == 0 ? "what a contact does to the clearance one cycle later" : "and later");
    facts.add("touches", static_cast<double>(map.touches), "places in which the orbit touches");
}

void add_verdict(Facts& facts, const Findings& found) {
    const Verdict& verdict = found.verdict;
    const auto logarithm = [](const std::optional<double>& value) {
        return value ? std::optional(std::log10(*value)) : std::nullopt;
    };
    facts.add("verdict", name_of(verdict.outcome), "what becomes of the orbit beyond the touch");
    facts.add("undecided", verdict.reason, "why");
    if (found.parameter && verdict.side != 0) {
        facts.add("parameter", found.stored.run.model.independent_parameters()[found.parameter->place()],
                  "that moves the orbit from the touch");
        facts.add("contacts_when", verdict.side > 0 ? "above" : "below", "side of the parameter on which they begin");
    }
    facts.add("clearance_rate", found.map.clearance_rate, "of the orbit without contact, by the parameter");
    facts.add("first_speed", verdict.first_speed, "of the first contact, by the root of the parameter's distance");
    if (verdict.attractor != AttractorKind::none)
        facts.add("attractors", name_of(verdict.attractor), "that remain");
    facts.add("leading", verdict.leading, "multiplier that decides which");
    if (verdict.next_contact > 0)
        facts.add("next_contact", static_cast<double>(verdict.next_contact),
                  "cycles until a contact is followed by another");
    facts.add("growth", verdict.growth, "the next approach speed, by the root of the one before");
    facts.add("log10_growth", logarithm(verdict.growth), "its decimal logarithm");
    facts.add("jump_growth", verdict.jump_growth, "c: the same of the jumps of the rate");
    facts.add("log10_jump_growth", logarithm(verdict.jump_growth), "its decimal logarithm");
    facts.add("reach", verdict.reach, "approach speed up to which contacts would grow");
    facts.add("alpha", verdict.alpha, "of the cubic alpha tau^3 + tau^2 + clearance, depth tau^2");
    facts.add("fold_clearance", verdict.fold_clearance, "clearance at which the orbit turns");
    facts.add("fold_depth", verdict.fold_depth, "depth at which the orbit turns");
    facts.add("fold_distance", verdict.fold_distance, "of the parameter from the touch");
    facts.add("unstable_depth", verdict.unstable_depth, "depth at which the orbit loses its stability before");
    if (found.trial) {
        facts.add("trial", name_of(found.trial->outcome), "simulation beside the touch");
        facts.add("trial_finds", found.trial->reason, "what it has shown");
    }
}

JsonObject heading_of(const ResultFile& file, const Findings& found) {
    const OrbitRecord& record = found.stored.record;
    JsonObject heading;
    heading.add("graze", GRAZE_VERSION);
    heading.add("file", file.path());
    heading.add("model", found.stored.run.model.name);
    heading.add("run", found.stored.run.record.name);
    heading.add("number", static_cast<double>(record.number));
    heading.add("label", record.label);
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
    found.parameter = parameter_of(found.stored.run, arguments.parameter);
    const System system(found.stored.run.model);
    const Orbit& orbit = found.stored.record.point.solution.orbit;
    CycleMapOptions options;
    options.parameter = found.parameter;
    found.map = cycle_map(system, orbit, touch_of(system, found.stored.record), options);
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
    deliver(facts.table(), arguments.output, heading_of(file, found), console);
    const bool contradicted = found.trial && found.trial->outcome == TrialOutcome::contradicted;
    return contradicted ? exit_irregular : exit_success;
}

} // namespace graze
