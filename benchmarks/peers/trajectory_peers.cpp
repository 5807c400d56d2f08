#include "trajectory_peers.hpp"

#include "graze_run.hpp"
#include "heyoka_peer.hpp"
#include "testbed_course.hpp"
#include "work_precision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace peers {

namespace {

using State = Course::State;
using Columns = std::vector<State>; ///< derivatives for each direction

constexpr std::array tolerances = {1e-8, 1e-14};
constexpr int run_periods = 30;       ///< of one run, which both repeat from the same state
constexpr int derivative_periods = 3; ///< later, derivatives on the stable orbit have decayed

/// The fastest of heyoka's choices, made ready.
template <class Peer>
struct Fastest {
    HeyokaChoice choice;
    std::unique_ptr<Peer> peer;
};

/// @param make returns a peer for a choice; @param run runs it; @param quick true: takes the first choice
template <class Peer, class Make, class Run>
Fastest<Peer> fastest_of(std::span<const HeyokaChoice> choices, bool quick, Make&& make, Run&& run) {
    Fastest<Peer> result;
    double least = INFINITY;
    for (const HeyokaChoice choice : choices.first(quick ? 1 : choices.size())) {
        auto peer = std::make_unique<Peer>(make(choice));
        constexpr double budget = 0.3;
        const double time = least_seconds(budget, [&] { run(*peer); });
        if (time < least) {
            least = time;
            result = {choice, std::move(peer)};
        }
    }
    return result;
}

/// Runs of heyoka along the course.
class HeyokaRun {
public:
    HeyokaRun(const Course& course, double tolerance, HeyokaOutput output, bool quick, std::size_t directions = 0)
        : fastest_(fastest_of<HeyokaPeer>(
              choices, quick,
              [&](HeyokaChoice choice) { return HeyokaPeer(course.groups, tolerance, output, choice, directions); },
              [&](HeyokaPeer& peer) { peer.run(course.start, course.phase, course.duration()); })) {}

    void run(const Course& course) { fastest_.peer->run(course.start, course.phase, course.duration()); }
    const HeyokaPeer& peer() const { return *fastest_.peer; }
    HeyokaChoice choice() const { return fastest_.choice; }

private:
    static constexpr std::array choices = {HeyokaChoice{false, true}, HeyokaChoice{false, false},
                                           HeyokaChoice{true, true}, HeyokaChoice{true, false}};
    Fastest<HeyokaPeer> fastest_;
};

/// The error at the end, and at the sections if they are told.
template <class Run>
double error_of(const Run& run, const Truth& truth, HeyokaOutput output) {
    double error = largest_difference(run.state(), truth.end);
    if (run.impacts() != truth.impacts)
        return INFINITY;
    if (output != HeyokaOutput::sections && output != HeyokaOutput::grid)
        return error;
    const std::vector<State> passages = run.passages();
    if (passages.size() != truth.sections.size())
        return INFINITY;
    for (std::size_t i = 0; i < passages.size(); ++i)
        error = std::max(error, largest_difference(passages[i], truth.sections[i]));
    return error;
}

/// Alternates two runs until they have taken the budget of seconds.
template <class Own, class Peer>
PairedTiming alternate(double budget, Own&& own, Peer&& peer) {
    PairedTiming timing(Clock::processor);
    const double end = read_clock(Clock::processor) + budget;
    do
        timing.round(own, peer);
    while (read_clock(Clock::processor) < end);
    return timing;
}

void print_head(const char* title) {
    std::printf("\n%s\n\n| output | tolerance | graze, periods/s | heyoka, periods/s | ratio | error, graze | error, "
                "heyoka | steps a period | heyoka with |\n|---|---|---|---|---|---|---|---|---|\n",
                title);
}

void print_row(const std::string& what, double tolerance, int periods, const PairedTiming& timing, double error,
               double peer_error, const std::string& steps, const HeyokaChoice& choice) {
    std::printf("| %s | %.0e | %.3g | %.3g | %.3f | %.1e | %.1e | %s | %s |\n", what.c_str(), tolerance,
                periods / timing.own(), periods / timing.peer(), timing.peer() / timing.own(), error, peer_error,
                steps.c_str(), choice.name().c_str());
    std::fflush(stdout);
}

struct NamedOutput {
    HeyokaOutput output;
    const char* name;
};
constexpr std::array outputs = {NamedOutput{HeyokaOutput::none, "none"},
                                NamedOutput{HeyokaOutput::sections, "two sections, as events"},
                                NamedOutput{HeyokaOutput::grid, "two sections, whose times heyoka is told"},
                                NamedOutput{HeyokaOutput::extrema, "two sections, and maxima of the displacement"}};

void compare_one(const Course& course, double budget, bool quick) {
    const Truth truth(course, course.duration_of_graze()), peer_truth(course, course.duration_of_heyoka());
    print_head("One trajectory on the period-3 orbit; errors after 30 periods and at all sections");
    for (const auto& [output, name] : outputs) {
        for (const double tolerance : tolerances) {
            GrazeRun own(course, tolerance, output);
            HeyokaRun heyoka(course, tolerance, output, quick);
            const PairedTiming timing = alternate(
                budget, [&] { own.run(); }, [&] { heyoka.run(course); });
            if (own.passages().size() != heyoka.peer().passages().size())
                throw std::runtime_error("graze and heyoka find different numbers of passages");
            print_row(name, tolerance, run_periods, timing, error_of(own, truth, output),
                      error_of(heyoka.peer(), peer_truth, output),
                      std::to_string(own.steps() / run_periods) + ", " +
                          std::to_string(heyoka.peer().steps() / run_periods),
                      heyoka.choice());
        }
    }
}

/// Both at many tolerances, and their speeds at equal error, the largest at all sections.
void compare_at_equal_error(const Course& course, double budget, bool quick) {
    constexpr HeyokaOutput output = HeyokaOutput::grid;
    constexpr std::array levels = {1e-7, 1e-9, 1e-11, 1e-13};
    constexpr int loosest = 5, tightest = 15; // powers of the tolerances
    const Truth truth(course, course.duration_of_graze()), peer_truth(course, course.duration_of_heyoka());
    std::vector<Effort> own, peer;
    for (int power = loosest; power <= tightest; ++power) {
        const double tolerance = std::pow(10.0, -power);
        GrazeRun run(course, tolerance, output);
        HeyokaRun heyoka(course, tolerance, output, quick);
        const PairedTiming timing = alternate(
            0.5 * budget, [&] { run.run(); }, [&] { heyoka.run(course); });
        own.push_back({tolerance, timing.own(), error_of(run, truth, output)});
        peer.push_back({tolerance, timing.peer(), error_of(heyoka.peer(), peer_truth, output)});
    }
    std::printf("\nOne trajectory with two sections, whose times heyoka is told, at equal error at all sections\n\n"
                "| error | graze, periods/s | heyoka, periods/s | ratio |\n|---|---|---|---|\n");
    for (const double level : levels) {
        const auto seconds = seconds_at(own, level), other = seconds_at(peer, level);
        if (seconds && other)
            std::printf("| %.0e | %.3g | %.3g | %.3f |\n", level, run_periods / *seconds, run_periods / *other,
                        *other / *seconds);
        else
            std::printf("| %.0e | %s | %s | - |\n", level, seconds ? "reached" : "-", other ? "reached" : "-");
    }
}

/// What outputs cost in each program by itself: the remaining share of its speed.
void compare_costs(const Course& course, double budget, bool quick) {
    std::printf("\nShare of its own speed that each program keeps with more output\n\n| output | tolerance | graze | "
                "heyoka |\n|---|---|---|---|\n");
    for (const auto& [output, name] : outputs) {
        if (output == HeyokaOutput::none)
            continue;
        for (const double tolerance : tolerances) {
            GrazeRun plain(course, tolerance, HeyokaOutput::none), more(course, tolerance, output);
            HeyokaRun peer_plain(course, tolerance, HeyokaOutput::none, quick),
                peer_more(course, tolerance, output, quick);
            const PairedTiming own = alternate(
                budget, [&] { more.run(); }, [&] { plain.run(); });
            const PairedTiming peer = alternate(
                budget, [&] { peer_more.run(course); }, [&] { peer_plain.run(course); });
            std::printf("| %s | %.0e | %.3f | %.3f |\n", name, tolerance, own.peer() / own.own(),
                        peer.peer() / peer.own());
            std::fflush(stdout);
        }
    }
}

void compare_ensembles(const Course& course, double budget, bool quick) {
    constexpr std::size_t count = 64, every = 8;
    constexpr double spread = 0.01; // of the voltage, in volts
    std::vector<double> voltages;
    for (std::size_t i = 0; i < count; ++i)
        voltages.push_back(course.groups.voltage + spread * static_cast<double>(i) / count / course.one.parameter_unit);
    std::vector<std::pair<State, State>> truth; // for graze and for heyoka
    for (std::size_t i = 0; i < count; i += every) {
        OdeintPeer::Parameters groups = course.groups;
        groups.voltage = voltages[i];
        const Motions motions = testbed_motions(groups);
        const auto end = [&](Reference::Real duration) {
            Reference reference = course.reference(motions);
            reference.advance(duration);
            return state_of(reference);
        };
        truth.emplace_back(end(course.duration_of_graze()), end(course.duration_of_heyoka()));
    }
    print_head("64 trajectories at voltages near that of the orbit: graze's Ensemble and heyoka's batches of 8; errors "
               "after 30 periods");
    constexpr std::array choices = {HeyokaChoice{.rotating_phase = false}, HeyokaChoice{.rotating_phase = true}};
    for (const double tolerance : tolerances) {
        GrazeGroup own(course, voltages, tolerance);
        const auto run_peer = [&](HeyokaEnsemble& ensemble) {
            ensemble.run(course.start, course.phase, voltages, course.duration());
        };
        const auto [choice, peer] = fastest_of<HeyokaEnsemble>(
            choices, quick, [&](HeyokaChoice tried) { return HeyokaEnsemble(course.groups, tolerance, tried); },
            run_peer);
        const PairedTiming timing = alternate(
            budget, [&] { own.run(); }, [&] { run_peer(*peer); });
        if (own.impacts() != peer->impacts())
            throw std::runtime_error("graze and heyoka find different numbers of impacts");
        double error = 0, peer_error = 0;
        for (std::size_t i = 0; i < truth.size(); ++i) {
            error = std::max(error, largest_difference(own.state(every * i), truth[i].first));
            peer_error = std::max(peer_error, largest_difference(peer->states()[every * i], truth[i].second));
        }
        print_row("none", tolerance, run_periods * static_cast<int>(count), timing, error, peer_error, "-", choice);
    }
}

template <class Run>
Columns columns_of(const Run& run, std::size_t directions) {
    Columns result;
    for (std::size_t d = 0; d < directions; ++d)
        result.push_back({run.derivative(0, d), run.derivative(1, d), run.derivative(2, d)});
    return result;
}

/// The largest difference of columns that both have, each relative to the size of the second.
double distance(const Columns& a, const Columns& b) {
    double result = 0;
    for (std::size_t d = 0; d < std::min(a.size(), b.size()); ++d)
        result = std::fmax(result, largest_difference(a[d], b[d]) / largest_difference(b[d], {}));
    return result;
}

void compare_derivatives_of_both(const Course& course, double budget, bool quick) {
    const Course brief(derivative_periods);
    const Truth truth(brief, brief.duration_of_graze());
    std::printf(
        "\nDerivatives: share of the motion's speed, and heyoka's time with them divided by graze's; errors after "
        "%d periods, by states and voltage; last, how far apart both are by all inputs\n\n| inputs | tolerance | "
        "graze | heyoka | ratio | error, graze | error, heyoka | apart |\n|---|---|---|---|---|---|---|---|\n",
        derivative_periods);
    for (const std::size_t directions : {1, 7, 8}) {
        for (const double tolerance : tolerances) {
            GrazeRun plain(course, tolerance, HeyokaOutput::none),
                more(course, tolerance, HeyokaOutput::none, directions),
                short_run(brief, tolerance, HeyokaOutput::none, directions);
            HeyokaRun peer_plain(course, tolerance, HeyokaOutput::none, quick),
                peer(course, tolerance, HeyokaOutput::none, true, directions);
            const PairedTiming own = alternate(
                budget, [&] { more.run(); }, [&] { plain.run(); });
            const PairedTiming other = alternate(
                budget, [&] { peer.run(course); }, [&] { peer_plain.run(course); });
            const PairedTiming both = alternate(
                budget, [&] { more.run(); }, [&] { peer.run(course); });
            short_run.run();
            peer.run(brief);
            const Columns columns = columns_of(short_run, directions),
                          peer_columns = columns_of(peer.peer(), directions);
            std::printf("| %zu | %.0e | %.3f | %.3f | %.3g | %.1e | %.1e | %.1e |\n", directions, tolerance,
                        own.peer() / own.own(), other.peer() / other.own(), both.peer() / both.own(),
                        distance(columns, truth.columns), distance(peer_columns, truth.columns),
                        distance(peer_columns, columns));
            std::fflush(stdout);
        }
    }
}

} // namespace

void compare_trajectories(bool quick) {
    const double budget = quick ? 0.05 : 2;
    const Course course(run_periods);
    compare_one(course, budget, quick);
    compare_at_equal_error(course, budget, quick);
    compare_ensembles(course, budget, quick);
    compare_costs(course, budget, quick);
    compare_derivatives_of_both(course, budget, quick);
}

} // namespace peers
