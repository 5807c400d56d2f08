#include "program/branch_arguments.hpp"

#include "graze/branch/special_point.hpp"
#include "program/commands.hpp"
#include "program/declared_option.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

std::string points_text() {
    std::string text = R"(List the special points of branches of periodic orbits.
A branch is the result of a study's run of kind "continue": periodic orbits over a parameter. Its special points are:
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
of one run (chain:GR1) or any point of a branch by its number (chain:17); graze points lists them. Another run can start
from the table as CSV. With --plot the orbit is drawn instead.)";

constexpr const char* orbit_examples = R"(Examples:
  graze orbit results GR1
  graze orbit results chain:GR1 --quantity energy --format csv --output orbit.csv
  graze orbit results chain:17 --plot orbit.svg
  graze orbit results GR1 --plot history.pdf --x t --y q,v)";

constexpr const char* ladder_text = R"(Follow a sequence of grazings, each with one contact more, to chatter.
At each grazing the branch of orbits with one contact more is followed until it grazes again. The distances between the
grazings shrink in a ratio that depends on the restitution. Contacts accumulate at their limit, the onset of chatter: it
is found from the motion and, independently, from the grazings alone. POINT is written as for graze orbit. A run of kind
"ladder" of a study also stores the orbits.)";

constexpr const char* ladder_examples = R"(Examples:
  graze ladder results GR1                         eight grazings, their ratios, their limit
  graze ladder results chain:GR1 --rungs 15
  graze ladder results GR1 --format json           every number, with all its digits)";

constexpr const char* grazing_text = R"(Decide whether an attractor survives a grazing bifurcation or is lost.
POINT is a grazing (GR), or any other point whose orbit touches an event's surface without speed; it is written as for
graze orbit. The discontinuity map follows from the model's equations alone. It tells how a contact acts on the motion,
in which later cycle the next contact comes, and whether an attractor remains. With --verify simulation checks the verdict.)";

constexpr const char* grazing_examples = R"(Examples:
  graze grazing results GR1                        the map of a contact, and the verdict
  graze grazing results chain:GR1 --verify         checked by simulations just beyond the grazing
  graze grazing results GR1 --format json          every number, with all its digits)";

constexpr const char* trip_text = R"(Compute how long a motion takes to be lost beyond a grazing or a fold.
At a grazing with the verdict `lost` (see graze grazing): the parameter is moved beyond it by each overshoot, and cycles and
time are counted until contacts are hard. The map of a cycle is valid for any overshoot, also for those too small to
simulate. The columns with `end` continue by simulation to the end that --until chooses; `simulated_time` is by simulation
alone, where the parameter has enough digits. At a fold (SN): cycles and time of the passage, by the normal form for any
overshoot, and by simulation from before the fold to beyond it. With --ramp, --wave or --noise the parameter changes in
time, and everything is simulated. POINT is written as for graze orbit.)";

constexpr const char* trip_examples = R"(Examples:
  graze trip results GR1                           ten overshoots from 1e-2 to 1e-20 of the parameter's size
  graze trip results GR1 --until end               until the motion itself ends, as by snap-through
  graze trip results GR1 --overshoot 1e-3:1e-9 --until q=0.9
  graze trip results SN1 --overshoot 1e-2:1e-6     passage through a fold
  graze trip results GR1 --beside SN1 --until end --plot trip.svg
  graze trip results GR1 --ramp 1e-4:1e-8          the value at which it trips when the parameter rises
  graze trip results GR1 --noise 0.001,0.002 --at 0.19)";

constexpr const char* tolerance_text = R"(Compute how a special point depends on the other parameters.
The value of the run's parameter at which the point lies, such as the voltage at which a switch trips, is a function of
all other parameters: its exact derivatives and, with --vary, its statistics over devices whose parameters differ, each
solved for by Newton's method. POINT is a grazing (GR), fold (SN), flip (PD) or any other whose curve could be followed,
written as for graze orbit.)";

constexpr const char* tolerance_examples = R"(Examples:
  graze tolerance results GR1                      derivatives by every parameter
  graze tolerance results GR1 --vary delta=1%,zeta=0.002
  graze tolerance results GR1 --vary delta=0.01:uniform --within 0.19:0.21 --plot yield.svg)";

/// Declares a command about one point of a branch.
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
    declare_option(command, group, "--run", arguments.runs, "RUN", "List only these runs (all branches)");
    declare_option(command, group, "--type", arguments.types, "TYPE",
                   "List only points of these types, such as GR,SN (all)");
    command.add_flag("--all", arguments.output.all, "List regular points (type RG) too, and show all columns")
        ->group(group);
    declare_output(command, arguments.output);
}

void declare_orbit(CLI::App& app, OrbitArguments& arguments) {
    CLI::App& command = declare_of_point(app, "orbit", orbit_text, orbit_examples, arguments);
    const char* group = "What to show";
    declare_option(command, group, "--quantity", arguments.quantities, "EXPR",
                   "Further columns: quantities of the model, or any expressions in its names");
    declare_option(command, group, "--samples", arguments.samples, "N", "Approximate number of rows of a period (200)")
        ->check(whole_number(1, 1'000'000));
    declare_table(command, arguments.output);
    group = "Picture";
    declare_option(command, group, "--plot", arguments.plot, "FILE", "Draw the orbit instead, as svg, png, pdf or eps");
    declare_option(command, group, "--x", arguments.x, "NAME",
                   "Horizontal axis: a state or quantity, or t for time histories (a state)");
    declare_option(command, group, "--y", arguments.y, "NAME",
                   "Vertical axes, one panel each (the velocity of --x; all states for --x t)");
    declare_data(command, arguments.data);
}

void declare_grazing(CLI::App& app, GrazingArguments& arguments) {
    CLI::App& command = declare_of_point(app, "grazing", grazing_text, grazing_examples, arguments);
    const char* group = "What to show";
    declare_option(command, group, "--parameter", arguments.parameter, "NAME",
                   "Parameter that moves the orbit through the grazing (the parameter of its run)");
    command.add_flag("--verify", arguments.verify, "Check the verdict by simulation near the grazing")->group(group);
    declare_table(command, arguments.output);
}

void declare_disturbances(CLI::App& command, TripArguments& arguments) {
    const char* group = "Parameter that changes in time";
    declare_option(command, group, "--ramp", arguments.ramps, "RATES",
                   "The parameter rises or falls linearly at these rates per unit of time: a list, or FIRST:LAST "
                   "for each decade");
    declare_option(command, group, "--wave", arguments.waves, "AMPLITUDES",
                   "The parameter oscillates about the value of --at with these amplitudes");
    declare_option(command, group, "--wave-period", arguments.wave_period, "CYCLES",
                   "Period of the wave in cycles of the orbit (100)")
        ->check(positive_number());
    declare_option(
        command, group, "--noise", arguments.noises, "LEVELS",
        "The parameter is the value of --at plus noise of these standard deviations, constant in each cycle");
    declare_option(command, group, "--memory", arguments.memory, "CYCLES",
                   "Correlation time of the noise in cycles (0: independent from cycle to cycle)")
        ->check(non_negative_number());
    declare_option(command, group, "--at", arguments.at, "VALUE",
                   "Undisturbed value of the parameter, before the point; for a ramp, its first value");
    declare_option(command, group, "--motions", arguments.motions, "N",
                   "Number of motions simulated at each level of noise (1000)")
        ->check(whole_number(1, 100'000'000));
    declare_option(command, group, "--seed", arguments.seed, "N", "Seed of the noise (1)")
        ->check(whole_number(0, 1'000'000'000));
    declare_option(command, group, "--jobs", arguments.jobs, "N",
                   "Threads (one for each core); results do not depend on them")
        ->check(whole_number(1, 1024));
}

void declare_trip(CLI::App& app, TripArguments& arguments) {
    CLI::App& command = declare_of_point(app, "trip", trip_text, trip_examples, arguments);
    const char* group = "What to compute";
    declare_option(command, group, "--parameter", arguments.parameter, "NAME",
                   "Parameter that is moved beyond the point (the parameter of its run)");
    declare_option(command, group, "--beside", arguments.beside, "POINT",
                   "Another point to compare, with overshoots of the same size");
    declare_option(command, group, "--overshoot", arguments.overshoots, "VALUES",
                   "Signed distances of the parameter beyond the point: a list, or FIRST:LAST for each decade");
    declare_option(command, group, "--disturbance", arguments.disturbances, "STATE=VALUE",
                   "Disturbance of the initial state, which is the state at the grazing (none)");
    auto* until =
        declare_option(command, group, "--until", arguments.until, "EXPR=LEVEL",
                       "End where EXPR reaches LEVEL, or `end`: where the motion itself ends (the map's limit; beyond "
                       "the fold)");
    declare_option(command, group, "--greatest-speed", arguments.greatest_speed, "SPEED",
                   "End at the first contact with this approach speed")
        ->check(positive_number())
        ->excludes(until);
    declare_option(command, group, "--cycles", arguments.cycles, "N",
                   "Largest number of simulated cycles, for a ramp of those beyond the point (2000; 100 under noise)")
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
    declare_option(command, group, "--rungs", arguments.rungs, "N",
                   "Largest number of grazings, POINT included (8); more come closer to the onset of chatter")
        ->check(whole_number(2, 1000));
    declare_option(command, group, "--parameter", arguments.parameter, "NAME",
                   "Parameter that varies (the parameter of its run, within the same bounds)");
    declare_table(command, arguments.output);
}

void declare_tolerance(CLI::App& app, ToleranceArguments& arguments) {
    CLI::App& command = declare_of_point(app, "tolerance", tolerance_text, tolerance_examples, arguments);
    const char* group = "What to find";
    declare_option(command, group, "--parameter", arguments.parameter, "NAME",
                   "Parameter whose value at the point is a function of the others (the parameter of its run)");
    declare_option(command, group, "--vary", arguments.vary, "NAME=SIZE",
                   "Standard deviations of parameters: numbers, or percentages of the value; SIZE:uniform: half width "
                   "of a uniform distribution");
    declare_option(command, group, "--within", arguments.within, "LOW:HIGH",
                   "Acceptable values, of which the yield is computed; one side may be left out");
    declare_option(command, group, "--devices", arguments.devices, "N",
                   "Number of devices that are drawn at random (10000)")
        ->check(whole_number(1, 100'000'000));
    declare_option(command, group, "--seed", arguments.seed, "N", "Seed of the random numbers (1)")
        ->check(whole_number(0, 1'000'000'000));
    declare_option(command, group, "--jobs", arguments.jobs, "N",
                   "Threads (one for each core); results do not depend on them")
        ->check(whole_number(1, 1024));
    declare_table(command, arguments.output);
    group = "Picture";
    declare_option(command, group, "--plot", arguments.plot, "FILE",
                   "Draw the distribution of the devices too, as svg, png or pdf");
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
