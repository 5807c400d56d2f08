#include "program/command_line.hpp"

#include "graze/branch/special_point.hpp"
#include "program/commands.hpp"

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
CommandLine::Declared<PointArguments> declare_of_point(CommandLine& line, const char* name, const char* text,
                                                       const char* examples,
                                                       int (*run)(const PointArguments&, const Console&)) {
    auto declared = line.command(name, text, examples, run);
    declared.options.add("FILE", declared.arguments.file, "Result file, or the folder of a study");
    declared.options.add("POINT", declared.arguments.point, "LABEL, RUN:LABEL or RUN:NUMBER");
    return declared;
}

void declare_points(CommandLine& line) {
    auto [options, points] = line.command("points", points_text(), points_examples, points_command);
    options.add("FILE", points.file, "Result file, or the folder of a study");
    options.in("What to show");
    options.add("--run RUN", points.runs, "List only these runs (all branches)");
    options.add("--type TYPE", points.types, "List only points of these types, such as GR,SN (all)");
    options.add("--all", points.output.all, "List regular points (type RG) too, and show all columns");
    options.output(points.output);
}

void declare_orbit(CommandLine& line) {
    auto [options, orbit] = declare_of_point(line, "orbit", orbit_text, orbit_examples, orbit_command);
    options.in("What to show");
    options.add("--quantity EXPR", orbit.quantities,
                "Further columns: quantities of the model, or any expressions in its names");
    options.add("--samples N", orbit.samples, "Approximate number of rows of a period (200)",
                whole_number(1, 1'000'000));
    options.table(orbit.output);
    options.picture(orbit.plot, orbit.data, "Draw the orbit instead, as svg, png, pdf or eps");
    options.add("--x NAME", orbit.x, "Horizontal axis: a state or quantity, or t for time histories (a state)");
    options.add("--y NAME", orbit.y, "Vertical axes, one panel each (the velocity of --x; all states for --x t)");
}

void declare_grazing(CommandLine& line) {
    auto [options, grazing] = declare_of_point(line, "grazing", grazing_text, grazing_examples, grazing_command);
    options.in("What to show");
    options.add("--parameter NAME", grazing.parameter,
                "Parameter that moves the orbit through the grazing (the parameter of its run)");
    options.add("--verify", grazing.verify, "Check the verdict by simulation near the grazing");
    options.table(grazing.output);
}

void declare_disturbances(CommandOptions& options, TripArguments& trip) {
    options.in("Parameter that changes in time");
    options.add("--ramp RATES", trip.ramps,
                "The parameter rises or falls linearly at these rates per unit of time: a list, or FIRST:LAST "
                "for each decade");
    options.add("--wave AMPLITUDES", trip.waves,
                "The parameter oscillates about the value of --at with these amplitudes");
    options.add("--wave-period CYCLES", trip.wave_period, "Period of the wave in cycles of the orbit (100)",
                positive_number());
    options.add("--noise LEVELS", trip.noises,
                "The parameter is the value of --at plus noise of these standard deviations, constant in each cycle");
    options.add("--memory CYCLES", trip.memory,
                "Correlation time of the noise in cycles (0: independent from cycle to cycle)", non_negative_number());
    options.add("--at VALUE", trip.at,
                "Undisturbed value of the parameter, before the point; for a ramp, its first value");
    options.add("--motions N", trip.motions, "Number of motions simulated at each level of noise (1000)",
                whole_number(1, 100'000'000));
    options.seed(trip.seed, "Seed of the noise (1)");
    options.jobs(trip.jobs);
}

void declare_trip(CommandLine& line) {
    auto [options, trip] = declare_of_point(line, "trip", trip_text, trip_examples, trip_command);
    options.in("What to compute");
    options.add("--parameter NAME", trip.parameter,
                "Parameter that is moved beyond the point (the parameter of its run)");
    options.add("--beside POINT", trip.beside, "Another point to compare, with overshoots of the same size");
    options.add("--overshoot VALUES", trip.overshoots,
                "Signed distances of the parameter beyond the point: a list, or FIRST:LAST for each decade");
    options.add("--disturbance STATE=VALUE", trip.disturbances,
                "Disturbance of the initial state, which is the state at the grazing (none)");
    auto* until =
        options.add("--until EXPR=LEVEL", trip.until,
                    "End where EXPR reaches LEVEL, or `end`: where the motion itself ends (the map's limit; beyond "
                    "the fold)");
    options
        .add("--greatest-speed SPEED", trip.greatest_speed, "End at the first contact with this approach speed",
             positive_number())
        ->excludes(until);
    options.add("--cycles N", trip.cycles,
                "Largest number of simulated cycles, for a ramp of those beyond the point (2000; 100 under noise)",
                whole_number(1, 1'000'000));
    declare_disturbances(options, trip);
    options.table(trip.output);
    options.picture(trip.plot, trip.data, "Draw the table instead, as svg, png, pdf or eps");
}

void declare_ladder(CommandLine& line) {
    auto [options, ladder] = declare_of_point(line, "ladder", ladder_text, ladder_examples, ladder_command);
    options.in("How far");
    options.add("--rungs N", ladder.rungs,
                "Largest number of grazings, POINT included (8); more come closer to the onset of chatter",
                whole_number(2, 1000));
    options.add("--parameter NAME", ladder.parameter,
                "Parameter that varies (the parameter of its run, within the same bounds)");
    options.table(ladder.output);
}

void declare_tolerance(CommandLine& line) {
    auto [options, tolerance] =
        declare_of_point(line, "tolerance", tolerance_text, tolerance_examples, tolerance_command);
    options.in("What to find");
    options.add("--parameter NAME", tolerance.parameter,
                "Parameter whose value at the point is a function of the others (the parameter of its run)");
    options.add("--vary NAME=SIZE", tolerance.vary,
                "Standard deviations of parameters: numbers, or percentages of the value; SIZE:uniform: half width "
                "of a uniform distribution");
    options.add("--within LOW:HIGH", tolerance.within,
                "Acceptable values, of which the yield is computed; one side may be left out");
    options.add("--devices N", tolerance.devices, "Number of devices that are drawn at random (10000)",
                whole_number(1, 100'000'000));
    options.seed(tolerance.seed, "Seed of the random numbers (1)");
    options.jobs(tolerance.jobs);
    options.table(tolerance.output);
    options.picture(tolerance.plot, tolerance.data, "Draw the distribution of the devices too, as svg, png or pdf");
}

} // namespace

void declare_branch_commands(CommandLine& line) {
    declare_points(line);
    declare_orbit(line);
    declare_grazing(line);
    declare_trip(line);
    declare_ladder(line);
    declare_tolerance(line);
}

} // namespace graze
