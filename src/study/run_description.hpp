#pragma once

#include "graze/base/text_file.hpp"
#include "study/measured_description.hpp"
#include "study/point_limits.hpp"
#include "study/run_forms.hpp"
#include "study/settings_fields.hpp"

#include <string>
#include <vector>

namespace graze {

// The keys of runs and the fields that are stored of them, each described once to a visitor `fields`: KeyReader reads
// studies, SettingsWriter and SettingsReader store settings and read them, KeyList lists the keys. The writer gets
// constant runs, hence the template parameters. Verbs: `form` is a key with a syntax of its own, read by the function
// given; `field` is stored without a key; `has` tells whether an optional field is or was written; `denied` is a key
// whose negation is stored; `later_number` is evaluated when the run is carried out; keys that are `read_apart` have
// their reader elsewhere. Stored texts are compared, so that the order of the fields must not change, and a new field
// is written only where it differs from its default.

/// Whether runs of this kind begin at a special point of another run, with its parameters.
inline bool begins_at_special_point(RunKind kind) {
    return kind == RunKind::ladder || kind == RunKind::torus;
}
/// Whether runs of orbits of this kind may begin at an initial state.
inline bool begins_anywhere(RunKind kind) {
    return kind == RunKind::orbit || kind == RunKind::equilibrium || kind == RunKind::follow;
}
/// The contents of the file of a run's table. Empty when the file cannot be read: the error is thrown when the run is
/// carried out.
std::string text_of_table(const BranchRequest& branch);
/// The part of a motion's settings that branches store too: a sampling at the section of the attractor.
MotionRequest motion_of_branch(const BranchRequest& branch);

template <class Fields, class Axis>
void describe_axis(Fields& fields, Axis& axis) {
    fields.field("name", axis.name);
    if (fields.has("values", !axis.values.empty())) {
        fields.field("values", axis.values);
        return;
    }
    describe_fields(fields, "low", axis.low, "high", axis.high, "logarithmic", axis.logarithmic, "offset", axis.offset);
}

template <class Fields, class Bounds>
void describe_bounds(Fields& fields, Bounds& bounds, const Model& model) {
    fields.list("bounds", bounds, [names = names_of(model.states)](auto& one, auto& bound) {
        one.named("state", bound.state, names);
        describe_fields(one, "least", bound.least, "greatest", bound.greatest);
    });
}

template <class Fields, class Box>
void describe_box(Fields& fields, Box& box, const Model& model) {
    fields.list("within", box, [names = names_of(model.states)](auto& one, auto& range) {
        one.named("state", range.state, names);
        describe_fields(one, "least", range.least, "greatest", range.greatest);
    });
}

template <class Fields, class One>
void describe_sampling(Fields& fields, One& sampling, const Model& model) {
    fields.field("name", sampling.name);
    if (fields.has("section", sampling.at == Sampling::At::section)) {
        fields.follows(sampling.at, Sampling::At::section);
        fields.field("section", sampling.section);
    }
    if (fields.has("extrema", sampling.at == Sampling::At::extremum)) {
        fields.follows(sampling.at, Sampling::At::extremum);
        fields.expression("extrema", sampling.expression);
        fields.number("direction", sampling.direction, 3);
    }
    if (fields.has("events", sampling.at == Sampling::At::contact)) {
        fields.follows(sampling.at, Sampling::At::contact);
        fields.field("events", sampling.events);
    }
    if (fields.has("image", sampling.symmetry.has_value())) {
        fields.follows(sampling.symmetry, std::optional<std::size_t>(0));
        fields.named("image", *sampling.symmetry, names_of(model.symmetries));
    }
}

template <class Fields, class One>
void describe_monitor(Fields& fields, One& monitor) {
    fields.field("name", monitor.name);
    fields.number("kind", monitor.kind, static_cast<std::size_t>(Monitor::Kind::conserved) + 1);
    fields.field("segment", monitor.segment);
    if (monitor.kind == Monitor::Kind::multiplier)
        fields.field("place", monitor.place);
    else if (monitor.kind != Monitor::Kind::duration)
        fields.expression("expression", monitor.expression);
    if (fields.has("in_modes", !monitor.in_modes.empty()))
        fields.expressions("in_modes", monitor.in_modes);
    describe_fields(fields, "fixed", monitor.fixed, "crossings", monitor.crossings);
    fields.optional("held", monitor.held);
    fields.optional("least", monitor.least);
    fields.optional("greatest", monitor.greatest);
}

/// What varies along a family.
template <class Fields, class Settings>
void describe_family(Fields& fields, Settings& branch) {
    if constexpr (Fields::stored)
        if (fields.has("family", branch.family.has_value())) {
            fields.follows(branch.family, std::optional<FamilyCoordinate>(FamilyCoordinate()));
            fields.field("family", branch.family->conserved);
            fields.optional("family_least", branch.family_least);
            fields.optional("family_greatest", branch.family_greatest);
        }
}

/// Along which parameters a branch is followed, and how far.
template <class Fields, class Run>
void describe_path(Fields& fields, Run& run, const std::vector<std::string>& parameters) {
    auto& branch = run.branch().settings;
    const bool plane = run.kind == RunKind::curve, begins_at_point = begins_at_special_point(run.kind);
    fields.form({"along", plane ? "the two parameters, with their bounds; one may be a conserved quantity or `period`"
                          : run.kind == RunKind::torus ? "the parameter along which tori are followed, with its bounds"
                          : run.kind == RunKind::ladder
                              ? "the parameter along which orbits are followed, with its bounds"
                              : "the parameter along which orbits are followed, with its bounds; or, along a "
                                "family at the same parameters, a conserved quantity or `period`"},
                plane             ? "{ omega = [0, 3], V = [0, 1] }"
                : begins_at_point ? "{ V = [0, 1] }"
                                  : "{ V = [0, 1] } or \"V\"",
                &read_along);
    describe_family(fields, branch);
    if (fields.has("along", !branch.family || plane))
        fields.named("along", branch.parameter, parameters);
    fields.count({"steps", "steps at most, each way"}, branch.steps, {1, most_branch_steps});
    if (fields.has("work", branch.work != BranchSettings().work))
        fields.field("work", branch.work);
    fields.form({"free",
                 plane ? "further parameters that vary: one for each fixed monitor, and one for a point VS. Without "
                         "`free`, fixed monitors are held in place of the point's own condition"
                       : "further parameters that vary, one for each fixed monitor; the branch ends where one of them "
                         "leaves its range. A list of names gives no ranges",
                 !begins_at_point},
                "{ omega = [0.1, 10] } or [\"omega\"]", &read_free);
    fields.named("free", branch.free, parameters);
    if (fields.has("free_bounds", !branch.free_bounds.empty()))
        fields.list("free_bounds", branch.free_bounds, [&parameters](auto& one, auto& bounds) {
            one.named("parameter", bounds.parameter, parameters);
            one.optional("least", bounds.least);
            one.optional("greatest", bounds.greatest);
        });
    fields.form({"stop", "types of points at which the branch ends", !begins_at_point}, "[\"GR\", \"SN\"]", &read_stop);
    fields.named("stop", branch.stop_at, short_names_of_points());
}

template <class Fields, class Run>
void describe_continuation(Fields& fields, Run& run) {
    auto& branch = run.branch().settings;
    describe_path(fields, run, run.model.independent_parameters());
    fields.denied({"unphysical", "continue along orbits that the model itself would not follow; they are drawn faint",
                   !begins_at_special_point(run.kind)},
                  "stop_when_unphysical", branch.stop_when_unphysical);
    fields.field("reorder", branch.reorder);
    fields.optional("least", branch.least);
    fields.optional("greatest", branch.greatest);
    fields.table({"step",
                  "steps of the continuation: the first, smallest and largest one in units of the orbit's size (0.01, "
                  "1e-8, 0.05), and the largest angle between two in radians (0.35). Where the branch is straight and "
                  "states are larger than their variation along the orbit, steps are up to ten times `largest`. With "
                  "a `largest` of 0.4 branches have half the points: steps are as long as that only where no special "
                  "point is near"},
                 "{ first, smallest, largest, angle }", [&step = branch.continuation](auto& one) {
                     one.number(key_in_table("first", "first_step"), step.first_step, positive_number);
                     one.number(key_in_table("smallest", "smallest_step"), step.smallest_step, positive_number);
                     one.number(key_in_table("largest", "largest_step"), step.largest_step, positive_number);
                     one.field("step_accuracy", step.accuracy);
                     one.number(key_in_table("angle", "largest_angle"), step.largest_angle, positive_number);
                     one.field("step_iterations", step.iterations);
                 });
    if (run.kind == RunKind::ladder)
        fields.count({"rungs", "largest number of grazings, the first one included"}, run.branch().rungs,
                     {2, most_rungs});
    if (run.kind == RunKind::torus) {
        auto& torus = run.branch().torus;
        fields.count({"harmonics",
                      "largest number of harmonics of the circle of a torus, beyond which it counts as not "
                      "resolved. The work grows with its third power"},
                     torus.harmonics, {TorusResolution::fewest_harmonics, TorusResolution::most_harmonics});
        fields.number({"tail", "largest share of the last harmonics, beyond which further ones are taken"}, torus.tail,
                      {TorusResolution::least_tail, TorusResolution::largest_tail});
    }
    if (run.kind != RunKind::torus && fields.has("grazing", run.branch().touches))
        fields.truth({"grazing", "store what becomes of orbits that touch, as `graze grazing` computes it: at "
                                 "grazings, and at all points of curves of touches"},
                     run.branch().touches);
    fields.form({"point_names", "further names of special points, for pictures, tables and wherever a point is "
                                "requested. A changed name does not make the run be computed again"},
                "{ GR1 = \"G-1\" }", &read_point_names);
}

template <class Fields, class Run>
void describe_branch(Fields& fields, Run& run) {
    auto& branch = run.branch().settings;
    const bool begins = run.kind == RunKind::orbit || run.kind == RunKind::follow;
    const bool rests = run.kind == RunKind::equilibrium;
    fields.form({"within",
                 "a box of states, in which all equilibria are searched for: in all modes, or in `mode` if that is "
                 "given. Without a box, the one is found to which Newton's method leads from the initial state",
                 rests},
                "{ x = [-1, 1], v = [-2, 2] }", &read_within);
    if (fields.has("within", !run.branch().within.empty()))
        describe_box(fields, run.branch().within, run.model);
    describe_if_given(fields, "every_mode", run.branch().every_mode);
    fields.form({"signature",
                 "segments of the orbit: labels of transitions or names of sections. The motion from the initial state "
                 "is followed until a part with these segments leads to an orbit",
                 begins},
                "\"J1 J8\"", &read_signature);
    fields.field("signature", run.branch().signature);
    fields.form({"table",
                 "CSV file with a motion close to the orbit: columns `segment`, `t` and the states. The first and the "
                 "last row of each segment are used",
                 begins},
                "\"FILE.csv\"", &read_orbit_table);
    if constexpr (Fields::reading)
        fields.field("table", run.branch().table_text);
    else
        fields.field("table", text_of_table(run.branch()));
    fields.form({"monitors", run.kind == RunKind::torus
                                 ? "named maxima and minima over each torus (the maxima of the states)"
                                 : "named numbers that are computed of each orbit (the period and the maxima of the "
                                   "states)"},
                "{ NAME = { ... } }", &read_monitors);
    fields.list("monitors", branch.monitors, [](auto& one, auto& monitor) { describe_monitor(one, monitor); });
    fields.number(
        {"accuracy",
         "largest last correction by Newton's method, for orbits and along branches, relative to each unknown"},
        branch.orbit.accuracy, positive_number);
    describe_fields(fields, "orbit_tolerance", branch.orbit.tolerance, "orbit_iterations", branch.orbit.iterations,
                    "error_estimate", branch.orbit.error_estimate);
    // An orbit that is given by its signature may be inadmissible too.
    if (run.is_followed())
        describe_continuation(fields, run);
    else
        fields.denied({"unphysical", "accept an orbit of this signature that is not admissible", !rests},
                      "stop_when_unphysical", branch.stop_when_unphysical);
}

template <class Fields, class Text>
void describe_section(Fields& fields, Text& section, bool offered) {
    fields.form({"section",
                 "section whose passages are counted as returns and periods (the first section of a phase, or the "
                 "first of all)",
                 offered},
                "\"NAME\"", &read_section);
    fields.field("section", section);
}

template <class Fields, class Transient>
void describe_transient(Fields& fields, Transient& transient) {
    describe_section(fields, transient.section, true);
    fields.form({"skip", "initial part of the motion that is not sampled"}, "{ time = T } or { periods = N }",
                &read_skip);
    fields.field("skip_time", transient.skip_time);
    fields.number({"time", "duration in units of the model's time; the motion ends by `time`, `periods` or `contacts`, "
                           "whichever comes first"},
                  transient.time, positive_number);
    fields.field("skip_periods", transient.skip_periods);
    fields.count({"periods", "number of passages of the section after which the motion ends"}, transient.periods, {1});
    fields.count({"contacts", "number of contacts after which the motion ends. Without `time` the motion is given up "
                              "as `failed` after a million steps without a counted contact or passage"},
                 transient.contacts, {1});
    fields.form({"events", "events whose contacts are counted (all barriers)"}, "[\"NAME\"] or true", &read_counted);
    fields.field("counted", transient.counted);
    fields.number({"greatest_speed", "approach speed at a counted contact beyond which the motion ends"},
                  transient.greatest_speed, positive_number);
}

template <class Fields, class Attractor>
void describe_attractor(Fields& fields, Attractor& attractor, RunKind kind) {
    const bool labels = seeks_attractors(kind);
    const bool settles = labels || kind == RunKind::orbit || kind == RunKind::follow;
    describe_section(fields, attractor.section, settles);
    fields.count({"cycles", "returns after which the search gives up", settles}, attractor.cycles,
                 {1, AttractorOptions::most_cycles});
    fields.count({"keep", "number of last returns that are sampled if the motion is not periodic", labels},
                 attractor.keep, {1, AttractorOptions::most_kept});
    fields.count({"largest_period", "longest period, in returns, of orbits that are searched for", settles},
                 attractor.largest_period, {1, AttractorOptions::most_returns});
    fields.number(
        {"recurrence",
         "distance from an earlier return, relative to the extent of the states, below which Newton's method is tried",
         settles},
        attractor.recurrence, {0, AttractorOptions::most_distance, false});
    fields.number({"disturbance",
                   "displacement of a motion that sits on an unstable orbit or equilibrium, or that looks chaotic and "
                   "lies on a plane: relative to the extent of the states or, at rest, to the length over which the "
                   "field is linear. 0: no displacement; such a motion is `unsettled`, and `detail` says why",
                   settles},
                  attractor.disturbance, {0, AttractorOptions::most_distance});
    fields.count({"lyapunov_cycles",
                  "how many of the last `cycles` the Lyapunov exponent is averaged over (half of `cycles` if that is "
                  "more); later returns count too. 0: no exponent, and chaos is not recognised",
                  labels},
                 attractor.lyapunov_cycles, {0, AttractorOptions::most_cycles});
    fields.count({"chaos_cycles",
                  "number of returns for which a motion that looks chaotic must remain so before it is labelled "
                  "`chaotic`; `cycles` if that is more",
                  labels},
                 attractor.chaos_cycles, {0, AttractorOptions::most_cycles});
    fields.number({"longest_return",
                   "time without a return after which a point is given up, whatever the number of steps (without it, "
                   "after 100,000 steps)",
                   settles},
                  attractor.longest_return, positive_number);
}

template <class Fields, class Start>
void describe_start(Fields& fields, Start& start) {
    fields.field("run", start.run);
    fields.optional("coordinate", start.coordinate);
    fields.field("value", start.value);
    fields.optional("direction", start.direction);
    describe_fields(fields, "point", start.point, "onto", start.onto);
}

/// What varies from point to point, and where motions begin.
template <class Fields, class Run, class Motion, class Request>
void describe_axes(Fields& fields, Run& run, Motion& motion, Request& request) {
    const bool points = run.has_motions();
    fields.form(
        {"vary",
         run.kind == RunKind::atlas
             ? "one or two parameters, each with a list or a range of values. Motions follow the first; each value of "
               "the second makes a row"
             : "parameters or initial states that differ from point to point. Several lists make a grid",
         points},
        run.kind == RunKind::atlas ? "{ V = { from, to, points }, omega = { from, to, points } }"
                                   : "{ V = { from, to, step } }",
        &read_vary);
    fields.list("vary", motion.axes, [](auto& one, auto& axis) { describe_axis(one, axis); });
    fields.form({"from",
                 points ? "initial states (those of the model). They may be expressions in the varied parameters and "
                          "initial states, which are evaluated at each point"
                        : "initial states (those of the model)",
                 points || begins_anywhere(run.kind)},
                "{ x = 0.1 }", read_apart);
    if (fields.has("following", !motion.following.empty()))
        fields.list("following", motion.following, [&](auto& one, auto& following) {
            one.named("state", following.state, names_of(run.model.states));
            one.expression("value", following.value);
        });
    fields.form({"mode", "the initial mode (that of the model)", points || begins_anywhere(run.kind)}, "\"NAME\"",
                read_apart);
    fields.form({"set", "values of further parameters in this run", !begins_at_special_point(run.kind)}, "{ V = 1 }",
                read_apart);
    fields.named("set", run.set, run.model.independent_parameters());
    if (fields.has("draws", motion.draws > 0)) {
        const bool may_draw = points && run.kind != RunKind::atlas; // whose points are those of a grid
        fields.count(
            {"draws", "number of points that are drawn at random for each combination of the listed values", may_draw},
            motion.draws, {1});
        fields.count({"seed", "seed of the random numbers", may_draw}, motion.seed, any_seed);
    }
    if (run.is_swept() || run.is_followed())
        fields.choice(
            {"direction",
             run.is_swept()
                 ? "direction of the first varied value: `both` is up, then down from where that ended"
                 : "direction of the parameter at first, since the branch turns at folds. It has no effect if "
                   "the run starts at a point and leads onto another branch, which has directions of its own",
             run.kind != RunKind::torus},
            request.direction, {"up", "down", "both"});
    if (run.is_swept())
        fields.truth(
            {"carry", "each point begins in the state in which the last one ended; `false`: in the initial state"},
            motion.carry);
}

template <class Fields, class Run, class Simulation>
void describe_integration(Fields& fields, const Run& run, Simulation& simulation) {
    const bool chosen = run.has_motions() || run.kind == RunKind::orbit || run.kind == RunKind::follow;
    fields.number({"tolerance", "tolerance of the integration in each step, relative to each state", true,
                   run.is_branch() ? "1e-13 of orbits, 1e-12 of what leads to them" : nullptr},
                  simulation.tolerance, positive_number);
    fields.count({"order", "order of the Taylor polynomials", chosen, "by tolerance"}, simulation.order);
    fields.number({"largest_step", "largest step of the integration, in units of the model's time (no limit)", chosen},
                  simulation.largest_step, positive_number);
    describe_fields(fields, "step_limit", simulation.step_limit, "contacts_at_once", simulation.contacts_at_once,
                    "touch", simulation.touch);
}

/// How far an exploration goes. It does not influence the points of the run; see sampling_settings_of.
template <class Fields, class Limits>
void describe_limits(Fields& fields, Limits& limits) {
    fields.count({"contacts",
                  "most contacts with barriers in one return (one period of the section) of orbits that are "
                  "followed"},
                 limits.contacts, {0, AtlasLimits::most_contacts});
    fields.count({"multiple", "longest period, in returns, of orbits that are followed"}, limits.multiple,
                 {1, AtlasLimits::most_multiple});
    fields.count({"branches", "number of branches after which no further one is followed"}, limits.branches,
                 {1, AtlasLimits::most_branches});
    fields.count({"curves", "number of curves after which no further one is followed. Curves need a second parameter"},
                 limits.curves, {0, AtlasLimits::most_curves});
    fields.form({"starts", "ranges of initial states from which motions begin at random, besides those of the sweep "
                           "(ranges about the extents of the sampled motions)"},
                "{ x = [-1, 1], v = [-2, 2] }", &read_starts);
    if (fields.has("starts", !limits.starts.empty()))
        fields.list("starts", limits.starts, [](auto& one, auto& start) {
            describe_fields(one, "state", start.state, "low", start.low, "high", start.high);
        });
    fields.count({"draws", "number of random initial states at every fourth value of each row"}, limits.draws,
                 {0, AtlasLimits::most_draws});
    fields.count({"seed", "seed of the random initial states"}, limits.seed, any_seed);
    fields.number({"minutes", "time of exploration after which no further branch or curve is begun (no limit)"},
                  limits.minutes, positive_number);
}

/// Runs that simulate. @param motion of a branch one without axes: what is stored of both is in the same order
template <class Fields, class Run, class Motion, class Request>
void describe_simulated(Fields& fields, Run& run, Motion& motion, Request& request) {
    const bool points = run.has_motions(), begins = points || run.kind == RunKind::orbit || run.kind == RunKind::follow;
    describe_axes(fields, run, motion, request);
    if (run.is_branch())
        fields.object("branch", [&](auto& one) { describe_branch(one, run); });
    const bool transient = points && !seeks_attractors(run.kind);
    if (transient)
        describe_transient(fields, motion.transient);
    else
        describe_attractor(fields, request.attractor, run.kind);
    fields.form({"bounds", "ranges of states; a motion that leaves them has escaped", begins}, "{ q = [-1, 1] }",
                &read_bounds);
    describe_bounds(fields, transient ? motion.transient.bounds : request.attractor.bounds, run.model);
    fields.form({"sample", "samplings: when values are taken (at the section)", points},
                "\"SECTION\" or { NAME = { ... } }", &read_samplings);
    fields.list("samplings", motion.samplings,
                [&](auto& one, auto& sampling) { describe_sampling(one, sampling, run.model); });
    fields.form({"values",
                 "states, quantities, definitions, parameters or expressions that are sampled; \"name = expression\" "
                 "gives a name (all states except phases and drifting ones)",
                 points},
                "[\"q\", \"speed = 2*v\"]", &read_values);
    fields.expressions("values", run.values);
    fields.field("value_names", run.value_names);
    fields.form({"start", run.is_branch() ? "the first orbit: a point of another run"
                                          : "the start: the last state of a point of another run of the same model"},
                "{ run, at, direction, point, onto }", &read_start);
    if constexpr (Fields::stored)
        if (fields.has("start", run.start.has_value())) {
            fields.follows(run.start, std::optional(StartFrom{}));
            fields.object("start", [&](auto& one) { describe_start(one, *run.start); });
        }
    fields.form({"parameters",
                 "runs of kind `identify`: what they have found takes the place of what is set (but what "
                 "the run varies)",
                 !begins_at_special_point(run.kind)},
                "\"RUN\" or [\"RUN\"]", &read_parameters);
    describe_if_given(fields, "parameters", run.parameters);
    describe_integration(fields, run, request.simulation);
    if (run.kind == RunKind::atlas && fields.has("atlas", motion.atlas != AtlasLimits()))
        fields.object("atlas", [&](auto& one) { describe_limits(one, motion.atlas); });
}

/// Records, and what is identified from them.
template <class Fields, class Run>
void describe_measured(Fields& fields, Run& run) {
    fields.field("value_names", run.value_names);
    if (run.kind == RunKind::record) {
        describe_levels(fields, run.record().vary);
        fields.object("record", [&](auto& one) { describe_record(one, run.record()); });
        fields.form({"values", "channels, or expressions of channels, as in other runs (all channels)"}, "[\"q\"]",
                    read_apart);
        fields.expressions("values", run.values);
        return;
    }
    describe_found_by(fields, run);
}

template <class Fields, class Run>
void describe(Fields& fields, Run& run) {
    if constexpr (!Fields::stored) {
        fields.form({"kind", "what the run does"}, "\"KIND\"", read_apart);
        fields.form({"text", "what it is for, in words"}, "text", read_apart);
        fields.form({"model", "another model"}, "\"NAME\" or \"./FILE.toml\"", read_apart);
    } else {
        auto kind = run.kind;
        fields.named("kind", kind, kinds_of_runs());
        if constexpr (Fields::reading)
            run.set_kind(kind);
    }
    if (run.is_measured())
        return describe_measured(fields, run);
    if (run.has_motions())
        return describe_simulated(fields, run, run.motion(), run.motion());
    MotionRequest none = motion_of_branch(run.branch());
    describe_simulated(fields, run, none, run.branch());
}

} // namespace graze
