// Wrong uses of attractors, simulations of many points, and plans.

#include "misuse/valid_objects.hpp"
#include "misuse/wrong_use.hpp"

#include "graze/sweep/plan.hpp"

// Omitted members of a struct have the defaults of its header.
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

namespace graze::sweep_misuse_test {

using namespace graze::testing;

using Values = std::vector<Expression>;

Sampling at_phase() {
    return {.name = "phase0", .section = "phase0"};
}
std::unique_ptr<SearchFactory> searches(const AttractorOptions& options = by_phase(),
                                        const Sampling& sampling = at_phase()) {
    const Model model = oscillator();
    return attractor_searches(System(model), options, {sampling}, {model.symbol("v")}, {});
}
std::unique_ptr<SearchFactory> short_searches(const Sampling& sampling = at_phase()) {
    const Model model = oscillator();
    return transient_searches(System(model), {.time = 1}, {sampling}, {model.symbol("v")}, {});
}

void attractor_options(WrongUses& wrong) {
    using Options = AttractorOptions;
    const auto option = wrong.spoiled<Options>(
        by_phase, {{"attractor_options", [](Options& o) { o.validate(oscillator()); }},
                   {"attractor_searches", [](Options& o) { keep(searches(o)); }},
                   {"find_orbit", [](Options& o) { keep(find_orbit(System(calm_oscillator()), o)); }}});
    option("section_empty", [](Options& o) { o.section = ""; });
    option("section_unknown", [](Options& o) { o.section = "unknown"; });
    option("cycles_0", [](Options& o) { o.cycles = 0; });
    option("largest_period_0", [](Options& o) { o.largest_period = 0; });
    option("largest_period_huge", [](Options& o) { o.largest_period = huge; });
    option("recurrence", not_positive(), [](Options& o, double value) { o.recurrence = value; });
    option("disturbance", negative(), [](Options& o, double value) { o.disturbance = value; });
    option("longest_return", negative(), [](Options& o, double value) { o.longest_return = value; });
    option("bounds_state", wrong_indices(3), [](Options& o, std::size_t i) { o.bounds = {{i, 0, 1}}; });
    option("bounds_reversed", [](Options& o) { o.bounds = {{0, 1, 0}}; });
    option("bounds_nan", [](Options& o) { o.bounds = {{0, not_a_number, 1}}; });
}

void transient_options(WrongUses& wrong) {
    using Options = TransientOptions;
    const auto option = wrong.spoiled<Options>(
        [] { return Options{.section = "phase0", .time = 1}; },
        {{"transient_options", [](Options& o) { o.validate(oscillator()); }},
         {"transient_searches", [](Options& o) { keep(transient_searches(System(oscillator()), o, {}, {}, {})); }}});
    option("no_end", [](Options& o) { o.time = 0; });
    option("section_unknown", [](Options& o) { o.section = "unknown"; });
    option("periods_without_section", [](Options& o) {
        o.section = "";
        o.periods = 3;
    });
    option("contacts_of_nothing", [](Options& o) { o.contacts = 3; });
    option("counted", wrong_indices(2), [](Options& o, std::size_t i) {
        o.contacts = 3;
        o.counted = {i};
    });
    option("time", negative(), [](Options& o, double value) { o.time = value; });
    option("skip_time", negative(), [](Options& o, double value) { o.skip_time = value; });
    option("greatest_speed", negative(), [](Options& o, double value) { o.greatest_speed = value; });
    option("bounds_state", wrong_indices(3), [](Options& o, std::size_t i) { o.bounds = {{i, 0, 1}}; });
    option("bounds_reversed", [](Options& o) { o.bounds = {{0, 1, 0}}; });
    option("bounds_nan", [](Options& o) { o.bounds = {{0, not_a_number, 1}}; });
}

void samplings(WrongUses& wrong) {
    const auto sampling =
        wrong.spoiled<Sampling>(at_phase, {{"attractor_sampling", [](Sampling& s) { keep(searches(by_phase(), s)); }},
                                           {"transient_sampling", [](Sampling& s) { keep(short_searches(s)); }}});
    sampling("by_default", [](Sampling& s) { s = {}; });
    sampling("section_unknown", [](Sampling& s) { s.section = "unknown"; });
    sampling("nowhere", [](Sampling& s) { s.at = static_cast<Sampling::At>(9); });
    sampling("extremum_of_nothing", [](Sampling& s) { s = {.at = Sampling::At::extremum}; });
    sampling("extremum_of_unknown",
             [](Sampling& s) { s = {.at = Sampling::At::extremum, .expression = Graph::create()->symbol("unknown")}; });
    sampling("contact_of_nothing", [](Sampling& s) { s = {.at = Sampling::At::contact}; });
    sampling("contact_event", wrong_indices(2),
             [](Sampling& s, std::size_t i) { s = {.at = Sampling::At::contact, .events = {i}}; });
    sampling("symmetry", wrong_indices(0), [](Sampling& s, std::size_t i) { s.symmetry = i; });
    for (const auto& [kind, value] : std::vector<std::pair<std::string, Expression>>{
             {"nothing", {}}, {"unknown", Graph::create()->symbol("unknown")}}) {
        wrong("attractor_value_" + kind, [value = value] {
            keep(attractor_searches(System(oscillator()), by_phase(), {at_phase()}, Values{value}, {}));
        });
        wrong("transient_value_" + kind, [value = value] {
            keep(transient_searches(System(oscillator()), {.time = 1}, {at_phase()}, Values{value}, {}));
        });
    }
    wrong("attractor_searches_simulation_options",
          [] { keep(attractor_searches(System(oscillator()), by_phase(), {}, {}, {.tolerance = not_a_number})); });
}

void point_searches(WrongUses& wrong) {
    const auto both = [&](const std::string& name, const std::function<void(PointSearch&)>& use) {
        wrong("attractor_search_" + name, [use] { use(*searches()->make()); });
        wrong("transient_search_" + name, [use] { use(*short_searches()->make()); });
    };
    const std::vector<double> parameters = oscillator().parameter_values(), state = oscillator().initial_state();
    for (const auto& [kind, length] : wrong_lengths(5))
        both("parameters_" + kind, [=, n = length](PointSearch& s) { s.begin(std::vector<double>(n, 0.5), state, 0); });
    for (const auto& [kind, length] : wrong_lengths(3))
        both("state_" + kind, [=, n = length](PointSearch& s) { s.begin(parameters, std::vector<double>(n), 0); });
    for (const auto& [kind, value] : not_finite()) {
        both("state_" + kind, [=, v = value](PointSearch& s) { s.begin(parameters, std::vector<double>{v, 0, 0}, 0); });
        both("parameters_" + kind, [=, v = value](PointSearch& s) { s.begin(std::vector<double>(5, v), state, 0); });
    }
    for (const auto& [kind, index] : wrong_indices(2))
        both("mode_" + kind, [=, i = index](PointSearch& s) { s.begin(parameters, state, i); });
    both("trajectory_before_begin", [](PointSearch& s) { keep(s.trajectory()); });
    both("proceed_before_begin", [](PointSearch& s) { keep(s.proceed()); });
    both("proceed_before_the_trajectory_is_run", [=](PointSearch& s) {
        s.begin(parameters, state, 0);
        keep(s.proceed());
    });
}

/// Four points in two chains that are computed quickly.
struct Execution {
    std::unique_ptr<SearchFactory> factory = transient_searches(System(oscillator()), {.time = 0.1}, {}, {}, {});
    Plan plan{.chains = 2, .chain_length = 2, .start = [](std::size_t) {
                  const Model model = oscillator();
                  return PointStart{model.parameter_values(), model.initial_state(), 0};
              }};
    KnownChains known;
    ExecutionOptions options;
    std::function<void(std::size_t, const PointStart&, PointResult&)> sink = [](auto&&...) {};
};

void executions(WrongUses& wrong) {
    const auto execution = wrong.spoiled<Execution>(
        [] { return Execution(); },
        {{"execute", [](Execution& e) { keep(execute(e.plan, *e.factory, e.known, e.options, e.sink)); }}});
    execution("without_start", [](Execution& e) { e.plan.start = {}; });
    execution("without_sink", [](Execution& e) { e.sink = {}; });
    execution("no_chains", [](Execution& e) { e.plan.chains = 0; });
    execution("chains_without_points", [](Execution& e) { e.plan.chain_length = 0; });
    execution("points_that_overflow", [](Execution& e) {
        e.plan.chains = e.plan.chain_length = std::size_t{1} << 33;
        e.sink = [](auto&&...) { throw std::bad_exception(); };
    });
    for (const int jobs : {0, -1, std::numeric_limits<int>::min()})
        execution("jobs_" + std::to_string(jobs), [jobs](Execution& e) { e.options.jobs = jobs; });
    execution("no_instruction_set", [](Execution& e) { e.options.instruction_set = static_cast<InstructionSet>(9); });
    execution("progress_of_no_chain", [](Execution& e) { e.known.begin(2, {.done = 1}); });
    execution("progress_end_of_no_chain", [](Execution& e) { e.known.end({1, 3}); });
    execution("progress_end_huge", [](Execution& e) { e.known.end({0, huge}); });
    execution("progress_end_reversed", [](Execution& e) { e.known.end({2, 1}); });
    execution("progress_done_too_much", [](Execution& e) { e.known.begin(0, {.done = 3}); });
    execution("progress_done_huge", [](Execution& e) { e.known.begin(0, {.done = huge}); });
    const auto carried = [&](const std::string& name, const ChainProgress& first) {
        execution("progress_" + name, [first](Execution& e) {
            e.plan.carry = true;
            e.known.begin(0, first);
        });
    };
    carried("without_state", {.done = 1, .regular = true});
    carried("state_too_long", {.done = 1, .regular = true, .state = std::vector<double>(4)});
    carried("state_nan", {.done = 1, .regular = true, .state = std::vector<double>(3, not_a_number)});
    carried("mode", {.done = 1, .regular = true, .state = {0, 0, 0}, .mode = 2});
    carried("mode_huge", {.done = 1, .regular = true, .state = {0, 0, 0}, .mode = huge});
    const auto start = [&](const std::string& name, const PointStart& one) {
        for (const int jobs : {1, 2})
            execution("start_" + name + "_jobs_" + std::to_string(jobs), [one, jobs](Execution& e) {
                e.options.jobs = jobs;
                e.plan.start = [one](std::size_t) { return one; };
            });
    };
    const std::vector<double> parameters = oscillator().parameter_values(), state = oscillator().initial_state();
    start("by_default", {});
    start("without_parameters", {{}, state, 0});
    start("without_state", {parameters, {}, 0});
    start("state_nan", {parameters, {0, not_a_number, 0}, 0});
    start("mode", {parameters, state, 2});
    execution("start_that_throws", [](Execution& e) {
        e.options.jobs = 2;
        e.plan.start = [](std::size_t) -> PointStart { throw InputError("no such point", ""); };
    });
    wrong("name_of_no_label", [] { keep(std::string(name_of(static_cast<Label>(99)))); });
}

TEST(WrongSweepUse, IsRefused) {
    expect_refusals({attractor_options, transient_options, samplings, point_searches, executions});
}

} // namespace graze::sweep_misuse_test
