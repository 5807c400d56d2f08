#include "program/branch_arguments.hpp"

#include "graze/branch/special_point.hpp"
#include "program/commands.hpp"
#include "program/declared_option.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

std::string points_text() {
    std::string text = R"(List the special points of branches of periodic orbits.
A branch is what a study's run of kind "continue" has followed: orbits over a parameter. Something happens at its
special points:
)";
    for (const PointKind& kind : point_kinds())
        text += fmt::format("  {}  {}\n", kind.short_name, kind.name);
    return text + "Their labels, such as GR1, are names for other commands.";
}

constexpr const char* points_examples = R"(Examples:
  graze points results                             all special points of all branches
  graze points results --run chain --type GR,SN    grazings and folds of one
  graze points results --all --format csv          every orbit, with all its multipliers
  graze orbit results GR1                          the motion at one of them)";

constexpr const char* orbit_text = R"(Show one periodic orbit of a branch.
Prints its motion over one period, segment by segment, with both sides of every jump. POINT is a label (GR1), a label
of one run (chain:GR1) or any point of a branch by its number (chain:17); graze points lists them. As CSV it can be
where another run starts. With --plot it is drawn instead.)";

constexpr const char* orbit_examples = R"(Examples:
  graze orbit results GR1
  graze orbit results chain:GR1 --quantity energy --format csv --output orbit.csv
  graze orbit results chain:17 --plot orbit.svg
  graze orbit results GR1 --plot history.pdf --x t --y q,v)";

constexpr const char* ladder_text = R"(Climb from one grazing to the next, with one contact more each time.
At each the branch of orbits with one contact more is followed until it grazes again. Their distances go down in a
ratio that the restitution decides; where they lead contacts accumulate: the onset of chatter, found from the motion
itself and, beside it, from the grazings alone. POINT is written as for graze orbit. A run of kind "ladder" of a study
keeps all of it, with the orbits.)";

constexpr const char* ladder_examples = R"(Examples:
  graze ladder results GR1                         eight grazings, their ratios, where they lead
  graze ladder results chain:GR1 --rungs 15
  graze ladder results GR1 --format json           every number, with all its digits)";

constexpr const char* grazing_text = R"(Say what becomes of an orbit that touches: persists, or trips?
At a grazing (GR), or any other point whose orbit touches an event's surface without speed: how a contact there acts on
the motion, which follows from the model's equations alone, on which later pass the next contact comes, and whether an
attractor remains beyond. With --verify the verdict is checked by simulation. POINT is written as for graze orbit.)";

constexpr const char* grazing_examples = R"(Examples:
  graze grazing results GR1                        what a contact does, and the verdict
  graze grazing results chain:GR1 --verify         checked by motions just beyond
  graze grazing results GR1 --format json          every number, with all its digits)";

constexpr const char* trip_text = R"(Say how long it takes until a motion is lost, at a touch or a fold.
At a touch whose verdict (graze grazing) is that the motion is lost: cycles and time from the touch, with the parameter
moved beyond by each overshoot, until contacts are hard. The map of a cycle tells it for any overshoot, also for those that
no simulation can see; the columns with `end` go on by simulation until the end that is asked for, and `simulated_time`
is simulation alone, where the digits of the parameter allow it. At a fold (SN): cycles and time of the passage by its
normal form, for any overshoot, and by simulation from before the fold to beyond it. With --ramp, --wave or --noise the
parameter changes in time instead, and all is by simulation. POINT is written as for graze orbit.)";

constexpr const char* trip_examples = R"(Examples:
  graze trip results GR1                           ten overshoots from 1e-2 to 1e-20 of the parameter's size
  graze trip results GR1 --until end               until the motion comes to its own end, as by snap-through
  graze trip results GR1 --overshoot 1e-3:1e-9 --until q=0.9
  graze trip results SN1 --overshoot 1e-2:1e-6     passage through a fold
  graze trip results GR1 --beside SN1 --until end --plot trip.svg
  graze trip results GR1 --ramp 1e-4:1e-8          the value at which it trips when the parameter rises
  graze trip results GR1 --noise 0.001,0.002 --at 0.19)";

constexpr const char* tolerance_text = R"(Say how far a special point depends on the other parameters.
The value of the run's parameter at which the point lies, such as the voltage at which a switch trips, is a function of
all other parameters: its exact derivatives and, with --vary, its statistics over devices whose parameters differ, each
solved for by Newton's method. POINT is a grazing (GR), fold (SN), flip (PD) or any other whose curve could be followed,
written as for graze orbit.)";

constexpr const char* tolerance_examples = R"(Examples:
  graze tolerance results GR1                      derivatives by every parameter
  graze tolerance results GR1 --vary delta=1%,zeta=0.002
  graze tolerance results GR1 --vary delta=0.01:uniform --within 0.19:0.21 --plot yield.svg)";

/// A command about one point of a branch.
template <class PointArguments>
CLI::App& declare_of_point(CLI::App& app, const char* name, const char* text, const char* examples,
                           PointArguments& arguments) {
    CLI::App& command = *app.add_subcommand(name, text);
    command.footer(examples);
    command.add_option("FILE", arguments.file, "Result file, or the folder of a study")->type_name("")->required();
    command.add_option("POINT", arguments.point, "LABEL, RUN:LABEL or RUN:NUMBER")->type_name("")->required();
    return command;
}

void declare_points(CLI::App& app, PointsArguments& arguments) {
    CLI::App& command = *app.add_subcommand("points", points_text());
    command.footer(points_examples);
    command.add_option("FILE", arguments.file, "Result file, or the folder of a study")->type_name("")->required();
    const char* group = "What to show";
    declare_option(command, group, "--run", arguments.runs, "RUN", "Only these runs (all branches)");
    declare_option(command, group, "--type", arguments.types, "TYPE", "Only points of these types, such as GR,SN");
    command.add_flag("--all", arguments.output.all, "The regular points between them too (type RG), and all columns")
        ->group(group);
    declare_output(command, arguments.output);
}

void declare_orbit(CLI::App& app, OrbitArguments& arguments) {
    CLI::App& command = declare_of_point(app, "orbit", orbit_text, orbit_examples, arguments);
    const char* group = "What to show";
    declare_option(command, group, "--quantity", arguments.quantities, "EXPR",
                   "More columns: quantities of the model, or any expressions in its names");
    declare_option(command, group, "--samples", arguments.samples, "N", "About so many rows of the whole period (200)")
        ->check(whole_number(1, 1'000'000));
    declare_table(command, arguments.output);
    group = "Picture";
    declare_option(command, group, "--plot", arguments.plot, "FILE", "Draw it instead, as svg, png, pdf or eps");
    declare_option(command, group, "--x", arguments.x, "NAME",
                   "Horizontal axis: a value, or t for histories (a state)");
    declare_option(command, group, "--y", arguments.y, "NAME",
                   "Vertical axes, one panel each (its velocity; of histories all states)");
    declare_data(command, arguments.data);
}

void declare_grazing(CLI::App& app, GrazingArguments& arguments) {
    CLI::App& command = declare_of_point(app, "grazing", grazing_text, grazing_examples, arguments);
    const char* group = "What to show";
    declare_option(command, group, "--parameter", arguments.parameter, "NAME",
                   "That moves the orbit from its touch (the one that its run follows)");
    command.add_flag("--verify", arguments.verify, "Check the verdict by simulation beside the touch")->group(group);
    declare_table(command, arguments.output);
}

void declare_disturbances(CLI::App& command, TripArguments& arguments) {
    const char* group = "Parameter that changes in time";
    declare_option(command, group, "--ramp", arguments.ramps, "RATES",
                   "It rises or falls steadily: rates by time, as a list or by decades");
    declare_option(command, group, "--wave", arguments.waves, "AMPLITUDES", "It swings about the value of --at");
    declare_option(command, group, "--wave-period", arguments.wave_period, "CYCLES", "Period of the wave (100)")
        ->check(positive_number());
    declare_option(command, group, "--noise", arguments.noises, "LEVELS",
                   "It is the value of --at plus noise of these standard deviations, constant in each cycle");
    declare_option(command, group, "--memory", arguments.memory, "CYCLES",
                   "After which the noise has forgotten all but 1/e of itself (0: at once)")
        ->check(non_negative_number());
    declare_option(command, group, "--at", arguments.at, "VALUE",
                   "Of the parameter at rest, before the point; of a ramp, where it begins");
    declare_option(command, group, "--motions", arguments.motions, "N", "How many under noise (1000)")
        ->check(whole_number(1, 100'000'000));
    declare_option(command, group, "--seed", arguments.seed, "N", "Of the noise (1)")
        ->check(whole_number(0, 1'000'000'000));
    declare_option(command, group, "--jobs", arguments.jobs, "N",
                   "Threads (one for each core); results do not depend on them")
        ->check(whole_number(1, 1024));
}

void declare_trip(CLI::App& app, TripArguments& arguments) {
    CLI::App& command = declare_of_point(app, "trip", trip_text, trip_examples, arguments);
    const char* group = "What to compute";
    declare_option(command, group, "--parameter", arguments.parameter, "NAME",
                   "That moves the orbit from the point (the one that its run follows)");
    declare_option(command, group, "--beside", arguments.beside, "POINT",
                   "The same at another point, with overshoots of the same size");
    declare_option(command, group, "--overshoot", arguments.overshoots, "VALUES",
                   "Of the parameter beyond the point, with sign: a list, or FIRST:LAST for each decade");
    declare_option(command, group, "--disturbance", arguments.disturbances, "STATE=VALUE",
                   "Added to the state of the touch in which the motion begins (none)");
    auto* until =
        declare_option(command, group, "--until", arguments.until, "EXPR=LEVEL",
                       "End there, or where the motion ends by itself: end (contacts as hard as the map can tell; the "
                       "fold is passed)");
    declare_option(command, group, "--greatest-speed", arguments.greatest_speed, "SPEED",
                   "End at a contact of this approach speed")
        ->check(positive_number())
        ->excludes(until);
    declare_option(command, group, "--cycles", arguments.cycles, "N",
                   "Cycles that are simulated at most (2000; 100 under noise; of a ramp those beyond the point)")
        ->check(whole_number(1, 1'000'000));
    declare_disturbances(command, arguments);
    declare_table(command, arguments.output);
    group = "Picture";
    declare_option(command, group, "--plot", arguments.plot, "FILE", "Draw the table instead, as svg, png, pdf or eps");
    declare_data(command, arguments.data);
}

void declare_ladder(CLI::App& app, LadderArguments& arguments) {
    CLI::App& command = declare_of_point(app, "ladder", ladder_text, ladder_examples, arguments);
    const char* group = "How far";
    declare_option(command, group, "--rungs", arguments.rungs, "N", "Grazings at most, that one included (8)")
        ->check(whole_number(2, 1000));
    declare_option(command, group, "--parameter", arguments.parameter, "NAME",
                   "That varies (the one that its run follows, within its bounds)");
    declare_table(command, arguments.output);
}

void declare_tolerance(CLI::App& app, ToleranceArguments& arguments) {
    CLI::App& command = declare_of_point(app, "tolerance", tolerance_text, tolerance_examples, arguments);
    const char* group = "What to find";
    declare_option(command, group, "--parameter", arguments.parameter, "NAME",
                   "Whose value follows from the others (the one that the run follows)");
    declare_option(
        command, group, "--vary", arguments.vary, "NAME=SIZE",
        "Parameters that differ from device to device: standard deviation, as a number or in percent of the value; "
        "with "
        ":uniform behind it the largest departure");
    declare_option(command, group, "--within", arguments.within, "LOW:HIGH",
                   "Values that are wanted; one side may be left out");
    declare_option(command, group, "--devices", arguments.devices, "N", "How many are made (10000)")
        ->check(whole_number(1, 100'000'000));
    declare_option(command, group, "--seed", arguments.seed, "N", "Of what is drawn (1)")
        ->check(whole_number(0, 1'000'000'000));
    declare_option(command, group, "--jobs", arguments.jobs, "N",
                   "Threads (one for each core); results do not depend on them")
        ->check(whole_number(1, 1024));
    declare_table(command, arguments.output);
    group = "Picture";
    declare_option(command, group, "--plot", arguments.plot, "FILE",
                   "Draw how the devices are distributed, too: svg, png or pdf");
    declare_data(command, arguments.data);
}

} // namespace

void declare_branch_commands(CLI::App& app, Arguments& arguments) {
    declare_points(app, arguments.points);
    arguments.add_command("points", points_command, arguments.points);
    declare_orbit(app, arguments.orbit);
    arguments.add_command("orbit", orbit_command, arguments.orbit);
    declare_grazing(app, arguments.grazing);
    arguments.add_command("grazing", grazing_command, arguments.grazing);
    declare_trip(app, arguments.trip);
    arguments.add_command("trip", trip_command, arguments.trip);
    declare_ladder(app, arguments.ladder);
    arguments.add_command("ladder", ladder_command, arguments.ladder);
    declare_tolerance(app, arguments.tolerance);
    arguments.add_command("tolerance", tolerance_command, arguments.tolerance);
}

} // namespace graze
