#include "branch_peers.hpp"

#include "../chain.hpp"
#include "../microactuator.hpp"
#include "auto_peer.hpp"
#include "work_precision.hpp"

#include "graze/branch/located_value.hpp"
#include "graze/branch/switching.hpp"
#include "graze/flow/mode_flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace peers {

namespace {

using namespace graze;

constexpr int fold_of_auto = 5, flip_of_auto = 7, value_of_auto = -4;

/// A branch of graze with its CPU time.
struct TimedBranch {
    std::vector<BranchPoint> points;
    std::vector<SpecialPoint> special;
    double seconds = 0;

    double milliseconds_per_point() const { return 1e3 * seconds / static_cast<double>(points.size()); }
    std::vector<double> located(PointType type) const {
        std::vector<double> result;
        for (const SpecialPoint& point : special)
            if (point.type == type)
                result.push_back(point.parameter);
        return result;
    }
};

/// Follows a branch until it ends or takes longer than a budget.
TimedBranch follow(const System& system, const Orbit& orbit, const BranchSettings& settings, double budget) {
    TimedBranch result;
    const double begin = read_clock(Clock::processor);
    Branch branch = follow_branch(system, orbit, settings, [&](const BranchPoint&, const std::vector<SpecialPoint>&) {
        return read_clock(Clock::processor) - begin < budget;
    });
    result.seconds = read_clock(Clock::processor) - begin;
    result.points = std::move(branch.points);
    result.special = std::move(branch.special);
    return result;
}

/// A branch with the usual steps and with long ones.
struct GrazeBranches {
    TimedBranch usual, long_steps;
};
constexpr double long_step = 0.4; // eight times the usual largest step, in scaled unknowns

/// Follows a branch with both, and keeps the least times of some repetitions.
GrazeBranches follow_both(const System& system, const Orbit& orbit, BranchSettings settings, double budget,
                          int repetitions) {
    GrazeBranches result;
    for (TimedBranch* const branch : {&result.usual, &result.long_steps}) {
        double least = std::numeric_limits<double>::infinity();
        for (int repetition = 0; repetition < repetitions; ++repetition) {
            *branch = follow(system, orbit, settings, budget);
            least = std::min(least, branch->seconds);
        }
        branch->seconds = least;
        settings.continuation.largest_step = long_step;
    }
    return result;
}

Orbit settled(const Model& model, std::size_t cycles = 4000) {
    AttractorOptions settle;
    settle.section = "phase0";
    settle.cycles = cycles;
    const OrbitSolution solution = find_orbit(System(model), settle);
    if (solution.outcome != OrbitOutcome::converged)
        throw std::runtime_error(model.name + " does not settle: " + solution.detail);
    return solution.orbit;
}

/// Returns the number of correct digits of a value, of the eleven that AUTO prints.
double digits(double value, double right) {
    return std::min(11.0, -std::log10(std::max(std::abs(value - right) / std::abs(right), 1e-17)));
}

/// "0.3166740397 (7.9)": each value with its number of correct digits against the nearest right value, if known.
std::string with_digits(const std::vector<double>& values, const std::vector<double>& right) {
    constexpr double same = 3; // digits that tell a value from another
    std::string text;
    for (const double value : values) {
        double most = 0;
        for (const double one : right)
            most = std::max(most, digits(value, one));
        char buffer[64];
        std::snprintf(buffer, sizeof buffer, "%s%.10g", text.empty() ? "" : ", ", value);
        text += buffer;
        if (most < same)
            continue;
        std::snprintf(buffer, sizeof buffer, " (%.1f)", most);
        text += buffer;
    }
    return text.empty() ? "-" : text;
}

std::string list_of(const std::vector<double>& values) {
    std::string text;
    for (const double value : values) {
        char buffer[64];
        std::snprintf(buffer, sizeof buffer, "%s%.13g", text.empty() ? "" : ", ", value);
        text += buffer;
    }
    return text.empty() ? "-" : text;
}

void print_row(const char* who, std::size_t points, double milliseconds, double from, double to,
               const std::string& located) {
    std::printf("| %s | %zu | %.3g | %.3g | %.4g to %.4g | %s |\n", who, points, milliseconds,
                1e-3 * milliseconds * static_cast<double>(points), from, to, located.c_str());
    std::fflush(stdout);
}

/// @param located, by_long_steps the special points of both
void print_rows(const GrazeBranches& branches, const std::string& located, const std::string& by_long_steps) {
    for (const auto& [name, branch, text] :
         {std::tuple{"graze, 1e-13", &branches.usual, &located},
          std::tuple{"graze, 1e-13, steps up to 0.4", &branches.long_steps, &by_long_steps}})
        print_row(name, branch->points.size(), branch->milliseconds_per_point(), branch->points.front().parameter,
                  branch->points.back().parameter, *text);
}

/// Prints how much longer AUTO takes for the whole stretch.
void print_ratio(const GrazeBranches& branches, const char* name, double seconds) {
    std::printf("\n%s takes %.2g times graze's time for the whole, %.2g times that with long steps.\n", name,
                seconds / branches.usual.seconds, seconds / branches.long_steps.seconds);
}

void print_head(const std::string& title, const char* parameter, const char* located) {
    std::printf("\n%s\n\n| | points | ms a point | s in all | %s | %s |\n|---|---|---|---|---|---|\n", title.c_str(),
                parameter, located);
}

double first_of(const AutoRun& run) {
    return run.points.front().columns.front();
}
double last_of(const AutoRun& run) {
    return run.points.back().columns.front();
}

/// Typical and fine meshes and accuracies of AUTO.
struct Fineness {
    const char* name;
    int intervals;
    double accuracy;
};
constexpr std::array fineness = {Fineness{"AUTO, 20 x 4, EPS 1e-7", 20, 1e-7},
                                 Fineness{"AUTO, 20 x 4, EPS 1e-9", 20, 1e-9},
                                 Fineness{"AUTO, 100 x 4, EPS 1e-9", 100, 1e-9}};

constexpr const Fineness& usual_fineness = fineness[1];

/// Writes the start orbit of AUTO: its two segments in parallel, each scaled to unit time.
void write_start(const Model& model, const Orbit& orbit) {
    constexpr int samples = 200;
    std::ofstream parameters("microactuator.par"), data("microactuator.dat");
    parameters.precision(17);
    data.precision(17);
    parameters << orbit.parameters[0] << ' ' << orbit.durations[0] << ' ' << orbit.durations[1] << '\n';
    ModeFlow flow(System(model), 1e-13);
    flow.set_parameters(orbit.parameters);
    std::vector<double> stick = orbit.starts[0], slip = orbit.starts[1];
    // Graze keeps the phase below pi.
    const double turns = slip[4] < stick[4] ? std::acos(-1.0) : 0;
    for (int i = 0; i <= samples; ++i) {
        data << static_cast<double>(i) / samples;
        for (const double value : {stick[2], stick[3], stick[4], slip[1], slip[2], slip[3], slip[4] + turns})
            data << ' ' << value;
        data << '\n';
        flow.run(orbit.signature[0].mode, stick, orbit.durations[0] / samples);
        flow.run(orbit.signature[1].mode, slip, orbit.durations[1] / samples);
    }
}

/// Compares the durations of both segments at requested voltages with graze's orbits there.
std::string durations_against(const AutoRun& run, const Model& model, const TimedBranch& branch) {
    double least = std::numeric_limits<double>::infinity();
    std::size_t count = 0;
    for (const AutoPoint& point : run.points) {
        if (point.type != value_of_auto)
            continue;
        // The branch passes each voltage twice: in the durations it tells which time it is.
        const double voltage = point.columns.front(), stick = point.columns[point.columns.size() - 2];
        const auto distance = [&](const BranchPoint& one) {
            return std::abs(one.parameter - voltage) + std::abs(one.solution.orbit.durations[0] - stick);
        };
        const auto near = std::min_element(
            branch.points.begin(), branch.points.end(),
            [&](const BranchPoint& one, const BranchPoint& other) { return distance(one) < distance(other); });
        Orbit guess = near->solution.orbit;
        guess.parameters[0] = voltage;
        const OrbitSolution exact = solve_orbit(System(model), guess);
        for (std::size_t s = 0; s < 2; ++s)
            least = std::min(least, digits(point.columns[point.columns.size() - 2 + s], exact.orbit.durations[s]));
        ++count;
    }
    char buffer[96];
    std::snprintf(buffer, sizeof buffer, "; durations at %zu orbits to %.1f digits", count, least);
    return count == 0 ? "" : buffer;
}

void compare_microactuator(bool quick) {
    const Model model = microactuator(microactuator_start);
    const System system(model);
    const Orbit& orbit = microactuator_orbit();
    TimedBranch branch;
    double least = std::numeric_limits<double>::infinity();
    for (int repeat = 0; repeat < (quick ? 1 : 5); ++repeat) {
        branch = follow(system, orbit, microactuator_settings(), std::numeric_limits<double>::infinity());
        least = std::min(least, branch.seconds);
    }
    branch.seconds = least;
    print_head("The microactuator's orbit {J1, J8} in V; AUTO solves its segments side by side, without multipliers",
               "V", "located (digits)");
    const std::vector<double> folds = branch.located(PointType::fold);
    print_row("graze, 1e-13", branch.points.size(), branch.milliseconds_per_point(), branch.points.front().parameter,
              branch.points.back().parameter, list_of(branch.located(PointType::flip)) + "; " + list_of(folds));
    write_start(model, orbit);
    for (const Fineness& one : fineness) {
        AutoSettings settings{.problem = "microactuator",
                              .constants = "IPS= 4, IRS= 0, dat= 'microactuator', ISP= 1, NBC= 9, NINT= 0\n"
                                           "ICP= [1, 2, 3], UZR= {1: [0.85, 0.9, 0.95]}",
                              .states = 7,
                              .intervals = one.intervals,
                              .points = 200,
                              .accuracy = one.accuracy,
                              .first_step = 0.001,
                              .largest_step = 0.0096};
        AutoRun run = run_auto(settings);
        for (int repeat = 1; repeat < (quick ? 1 : 3); ++repeat)
            run.seconds = std::min(run.seconds, run_auto(settings).seconds);
        print_row(one.name, run.points.size(), run.milliseconds_per_point(), first_of(run), last_of(run),
                  "- ; " + with_digits(run.located(fold_of_auto), folds) + durations_against(run, model, branch));
    }
}

void compare_resting(bool quick) {
    Model model = microactuator(0.1);
    BranchSettings settings;
    settings.greatest = 0.65;
    settings.least = 0.05;
    const System system(model);
    const GrazeBranches branches = follow_both(system, settled(model), settings, 60, quick ? 1 : 5);
    const TimedBranch &branch = branches.usual, &longer = branches.long_steps;
    const std::vector<double> flips = branch.located(PointType::flip), folds = branch.located(PointType::fold);
    print_head("The microactuator without impacts in V, with multipliers", "V", "flips; folds (digits)");
    print_rows(branches, list_of(flips) + "; " + list_of(folds),
               with_digits(longer.located(PointType::flip), flips) + "; " +
                   with_digits(longer.located(PointType::fold), folds));
    double seconds = 0;
    for (const Fineness& one : fineness) {
        const AutoRun run = run_auto({.problem = "resting",
                                      .constants = "IPS= 2, IRS= 0, ISP= 2, NBC= 0, NINT= 0\n"
                                                   "ICP= [1, 11], NPAR= 11, THL= {11: 0.0}, STOP= ['LP1']",
                                      .states = 4,
                                      .intervals = one.intervals,
                                      .points = 200,
                                      .accuracy = one.accuracy});
        print_row(one.name, run.points.size(), run.milliseconds_per_point(), first_of(run), last_of(run),
                  with_digits(run.located(flip_of_auto), flips) + "; " + with_digits(run.located(fold_of_auto), folds));
        if (one.name == usual_fineness.name)
            seconds = run.seconds;
    }
    print_ratio(branches, usual_fineness.name, seconds);
}

/// Runs AUTO's curve through the first point of a type on the branch in V, over the frequency.
AutoRun curve_of_auto(const Fineness& one, int type) {
    AutoSettings settings{.problem = "resting",
                          .constants = "IPS= 2, IRS= 0, ISP= 2, NBC= 0, NINT= 0\n"
                                       "ICP= [1, 11], NPAR= 11, THL= {11: 0.0}, STOP= ['LP1']",
                          .states = 4,
                          .intervals = one.intervals,
                          .points = 200,
                          .accuracy = one.accuracy};
    const AutoRun branch = run_auto(settings);
    const auto point = std::find_if(branch.points.begin(), branch.points.end(),
                                    [&](const AutoPoint& found) { return found.type == type; });
    if (point == branch.points.end())
        throw std::runtime_error("AUTO has found no point of the type whose curve is to be followed");
    // The first run only makes starting data, whose label is the last.
    double seconds = 0;
    int label = point->label;
    AutoRun run;
    for (int part = 0; part < 2; ++part) {
        keep_solutions();
        settings.constants = "IPS= 2, IRS= " + std::to_string(label) +
                             ", ISP= 0, ISW= 2, NBC= 0, NINT= 0\n"
                             "ICP= [2, 1, 11], NPAR= 11, THL= {11: 0.0}, UZSTOP= {2: [0.7, 1.5]}";
        run = run_auto(settings);
        label = run.points.back().label;
        seconds += run.seconds;
    }
    run.seconds = seconds;
    return run;
}

/// Returns the smallest number of correct digits of AUTO's points. Of frequency and voltage, the one that changes less
/// along the curve is compared with graze's solution at the value of the other, so that folds of the curve are not
/// ill-conditioned.
double digits_of(const AutoRun& run, const System& system, const SpecialPoint& kept, const TimedBranch& curve,
                 ParameterId voltage, ParameterId frequency) {
    constexpr std::size_t column = 6; // of the voltage: after the frequency, the norm and four maxima
    double least = std::numeric_limits<double>::infinity();
    for (const AutoPoint& point : run.points) {
        const auto distance = [&](const BranchPoint& one) {
            const std::vector<double>& values = one.solution.orbit.parameters;
            return std::hypot(values[frequency.place()] - point.columns.front(),
                              values[voltage.place()] - point.columns[column]);
        };
        const auto nearest = std::min_element(
            curve.points.begin(), curve.points.end(),
            [&](const BranchPoint& one, const BranchPoint& other) { return distance(one) < distance(other); });
        SpecialPoint near = kept;
        near.solution = nearest->solution;
        const std::vector<double>& rise = nearest->tangent.parameters; // of the frequency, then the voltage
        const bool turns = std::abs(rise[1]) > std::abs(rise[0]);
        const double given = point.columns[turns ? column : 0], wanted = point.columns[turns ? 0 : column];
        LocatedValue value(system, near, turns ? frequency : voltage, {turns ? voltage : frequency});
        const LocatedSolution exact = value({&given, 1});
        least = std::min(least, exact.found ? digits(wanted, exact.value) : 0);
    }
    return least;
}

/// Curves of the fold and of the first flip in two parameters.
void compare_curves(bool quick) {
    // Digits: AUTO's accuracy is 1e-7 or 1e-9 of a correction, and its points are better.
    constexpr double agreement = 8;
    Model model = microactuator(0.1);
    BranchSettings settings;
    settings.greatest = 0.65;
    settings.least = 0.05;
    const System system(model);
    const TimedBranch branch = follow(system, settled(model), settings, 60);
    for (const auto& [type, type_of_auto, name] :
         {std::tuple{PointType::fold, fold_of_auto, "fold"}, std::tuple{PointType::flip, flip_of_auto, "first flip"}}) {
        const auto point = std::find_if(branch.special.begin(), branch.special.end(),
                                        [type = type](const SpecialPoint& found) { return found.type == type; });
        const ParameterId voltage = settings.parameter, frequency = model.independent_parameter("omega");
        print_head(std::string("The curve of its ") + name + " in the frequency and V", "omega", "digits");
        const AutoRun first = curve_of_auto(fineness.front(), type_of_auto);
        BranchSettings along;
        along.parameter = frequency;
        along.direction = first.points[1].columns.front() < first_of(first) ? -1 : 1;
        along.least = 0.7;
        along.greatest = 1.5;
        along.free = {voltage};
        along.kept = *point;
        const GrazeBranches curves = follow_both(system, point->solution.orbit, along, 60, quick ? 1 : 5);
        const TimedBranch& curve = curves.usual;
        print_rows(curves, "-", "-");
        double seconds = 0;
        for (const Fineness& one : fineness) {
            const AutoRun run = curve_of_auto(one, type_of_auto);
            const double agreed = digits_of(run, system, *point, curve, voltage, frequency);
            if (!(agreed >= agreement))
                throw std::runtime_error(std::string("the curves of the ") + name + " do not agree");
            char text[96];
            std::snprintf(text, sizeof text, "%.1f at least; %.2g times graze's time a point", agreed,
                          run.milliseconds_per_point() / curve.milliseconds_per_point());
            print_row(one.name, run.points.size(), run.milliseconds_per_point(), first_of(run), last_of(run), text);
            if (one.name == usual_fineness.name)
                seconds = run.seconds;
        }
        print_ratio(curves, usual_fineness.name, seconds);
    }
}

/// Compares branches of the chain far from its walls, so that both programs follow the same branch.
void compare_chain(std::size_t oscillators, bool quick) {
    constexpr double far = 100, first_force = 0.05, last_force = 2;
    Model model = chain(oscillators, first_force);
    model.set_parameter("wall", far);
    BranchSettings settings;
    settings.least = 0.01;
    settings.greatest = last_force;
    settings.steps = quick ? 40 : 2000;
    const System system(model);
    const GrazeBranches branches = follow_both(system, settled(model), settings, quick ? 2 : 20, quick ? 1 : 3);
    const std::vector<double> folds = branches.usual.located(PointType::fold);
    print_head("The chain of " + std::to_string(oscillators) + " without contacts in F, with multipliers", "F",
               "folds (digits)");
    print_rows(branches, list_of(folds), with_digits(branches.long_steps.located(PointType::fold), folds));
    double seconds = 0;
    for (const Fineness& one : fineness) {
        if (quick && one.intervals > 20)
            continue;
        const AutoRun run = run_auto({.problem = "chain",
                                      .constants = "IPS= 2, IRS= 0, ISP= 2, NBC= 0, NINT= 0\n"
                                                   "ICP= [1, 11], NPAR= 11, THL= {11: 0.0}, UZSTOP= {1: 2}",
                                      .states = static_cast<int>(2 * oscillators + 2),
                                      .intervals = one.intervals,
                                      .points = one.intervals > 20 ? 20 : 40,
                                      .accuracy = one.accuracy,
                                      .first_step = 0.1,
                                      .largest_step = 0.5});
        print_row(one.name, run.points.size(), run.milliseconds_per_point(), first_of(run), last_of(run),
                  with_digits(run.located(fold_of_auto), folds));
        if (one.name == usual_fineness.name)
            seconds = run.seconds;
    }
    print_ratio(branches, usual_fineness.name, seconds);
}

} // namespace

void compare_branches(bool quick) {
    compare_microactuator(quick);
    compare_resting(quick);
    compare_curves(quick);
    for (const std::size_t oscillators : quick ? std::vector<std::size_t>{5} : std::vector<std::size_t>{5, 10, 20})
        compare_chain(oscillators, quick);
}

} // namespace peers
