// Invalid orbits and signatures.

#include "misuse/valid_objects.hpp"
#include "misuse/wrong_use.hpp"

#include "graze/branch/monitor.hpp"
#include "graze/orbit/orbit_file.hpp"

// Omitted members of a struct have the defaults of its header.
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

namespace graze::orbit_misuse_test {

using namespace graze::testing;

Orbit right_orbit() {
    return {.signature = {{.mode = 0, .end = SegmentEnd::section, .index = 0}},
            .parameters = calm_oscillator().parameter_values(),
            .starts = {{0.1, 0.1, 0}},
            .durations = {5.2},
            .symmetry = std::nullopt};
}

void defective_orbits(WrongUses& wrong) {
    const auto orbit = wrong.spoiled<Orbit>(
        right_orbit,
        {{"validate_orbit", [](Orbit& o) { validate_orbit(calm_oscillator(), o); }},
         {"solve_orbit", [](Orbit& o) { keep(solve_orbit(System(calm_oscillator()), o)); }},
         {"whole_orbit", [](Orbit& o) { keep(whole_orbit(System(calm_oscillator()), o)); }},
         {"half_orbit", [](Orbit& o) { keep(half_orbit(System(calm_oscillator()), o)); }},
         {"orbit_branch", [](Orbit& o) { keep(OrbitBranch(System(calm_oscillator()), o, by_amplitude())); }},
         {"follow_branch", [](Orbit& o) { keep(follow_branch(System(calm_oscillator()), o, by_amplitude())); }},
         {"monitors",
          [](Orbit& o) {
              keep(OrbitMonitors(System(calm_oscillator()), calm_orbit().signature, {{.name = "period"}})(o));
          }},
         {"image_of", [](Orbit& o) {
              keep(
                  image_of(System(symmetric_oscillator()), 0, o.signature.empty() ? Segment{huge} : o.signature[0], o));
          }}});
    orbit("by_default", [](Orbit& o) { o = {}; });
    orbit("signature_empty", [](Orbit& o) { o.signature.clear(); });
    orbit("signature_longer", [](Orbit& o) { o.signature.push_back(o.signature[0]); });
    orbit("segment_without_end", [](Orbit& o) { o.signature[0].end = static_cast<SegmentEnd>(9); });
    orbit("segment_by_default", [](Orbit& o) { o.signature[0] = {.mode = 1}; });
    orbit("start_missing", [](Orbit& o) { o.starts.clear(); });
    orbit("start_too_many", [](Orbit& o) { o.starts.push_back(o.starts[0]); });
    orbit("duration_missing", [](Orbit& o) { o.durations.clear(); });
    orbit("duration_too_many", [](Orbit& o) { o.durations.push_back(1); });
    orbit("duration_negative", [](Orbit& o) { o.durations[0] = -1; });
    orbit("symmetry_0", [](Orbit& o) { o.symmetry = 0; });
    orbit("symmetry_1", [](Orbit& o) { o.symmetry = 1; });
    orbit("symmetry_huge", [](Orbit& o) { o.symmetry = huge; });
    orbit("cycle_of_nothing", [](Orbit& o) { o.cycle = 0; });
    orbit("cycle_of_all", [](Orbit& o) { o.cycle = 1; });
    orbit("cycle_huge", [](Orbit& o) { o.cycle = huge; });
    orbit("parameters", wrong_lengths(5), [](Orbit& o, std::size_t n) { o.parameters.resize(n); });
    orbit("start", wrong_lengths(3), [](Orbit& o, std::size_t n) { o.starts[0].resize(n); });
    orbit("parameter", not_finite(), [](Orbit& o, double v) { o.parameters[0] = v; });
    orbit("start", not_finite(), [](Orbit& o, double v) { o.starts[0][1] = v; });
    orbit("duration", not_finite(), [](Orbit& o, double v) { o.durations[0] = v; });
    orbit("mode", wrong_indices(2), [](Orbit& o, std::size_t i) { o.signature[0].mode = i; });
    orbit("section", wrong_indices(2), [](Orbit& o, std::size_t i) { o.signature[0].index = i; });
    orbit("transition", wrong_indices(2),
          [](Orbit& o, std::size_t i) { o.signature[0] = {.end = SegmentEnd::event, .index = i}; });
    // With an orbit of the symmetric model: half orbits have more requirements than whole ones.
    const Orbit right = right_orbit();
    wrong("image_under_symmetry", wrong_indices(symmetric_oscillator().symmetries.size()),
          [right](std::size_t i) { keep(image_of(System(symmetric_oscillator()), i, right.signature[0], right)); });
    wrong("validate_signature_symmetry", wrong_indices(symmetric_oscillator().symmetries.size()),
          [right](std::size_t i) { validate_signature(symmetric_oscillator(), right.signature, {}, i); });
}

void signatures(WrongUses& wrong) {
    for (const std::string text :
         {"", "  ", "unknown", "impact^0", "impact^-1", "impact^", "^2", "(impact", "impact)", "{}",
          "impact^99999999999999999999", "impact^1000000000", "unknown:impact", "stuck:impact", "impact:", ":",
          "release release", "impact^2.5", "((impact^9999)^9999)^9999"})
        wrong("parse_signature_" + text, [text] { keep(parse_signature(oscillator(), text)); });
    const auto segment = [&](const std::string& name, const Segment& one) {
        wrong("end_name_" + name, [one] { keep(std::string(end_name(oscillator(), one))); });
        wrong("to_string_" + name, [one] { keep(to_string(oscillator(), Signature{one})); });
        wrong("validate_signature_" + name, [one] { validate_signature(oscillator(), Signature{one}); });
        wrong("orbit_monitors_signature_" + name,
              [one] { keep(OrbitMonitors(System(oscillator()), Signature{one}, {{.name = "period"}})); });
        wrong("orbit_with_signature_" + name, [one] {
            keep(orbit_with_signature(System(oscillator()), Signature{one}, {}, {},
                                      {.steps = 200, .segments = 20, .trials = 1}));
        });
    };
    for (const auto& [kind, index] : wrong_indices(2)) {
        segment("mode_" + kind + "_", {.mode = index});
        segment("transition_" + kind, {.index = index});
        segment("section_" + kind, {.end = SegmentEnd::section, .index = index});
    }
    segment("no_end", {.end = static_cast<SegmentEnd>(9)});
    segment("transition_of_another_mode", {.mode = 1});
    wrong("validate_signature_empty", [] { validate_signature(oscillator(), {}); });
    wrong("orbit_monitors_signature_empty",
          [] { keep(OrbitMonitors(System(oscillator()), {}, {{.name = "period"}})); });
    wrong("orbit_with_signature_empty", [] { keep(orbit_with_signature(System(oscillator()), {})); });
}

void wrong_orbit_options(WrongUses& wrong) {
    using Options = OrbitOptions;
    const auto option = wrong.spoiled<Options>(
        [] { return Options(); },
        {{"orbit_options", &Options::validate},
         {"solve_orbit_with", [](Options& o) { keep(solve_orbit(System(calm_oscillator()), calm_orbit(), o)); }},
         {"find_orbit_with", [](Options& o) { keep(find_orbit(System(calm_oscillator()), by_phase(), o)); }},
         {"orbit_with_signature_with", [](Options& o) {
              keep(orbit_with_signature(System(calm_oscillator()), parse_signature(oscillator(), "phase0"), o));
          }}});
    for (const double value : {0.0, -1.0, 1.0, 1e-17, not_a_number, infinity})
        option("tolerance_" + std::to_string(value), [value](Options& o) { o.tolerance = value; });
    option("accuracy", not_positive(), [](Options& o, double v) { o.accuracy = v; });
    option("iterations_0", [](Options& o) { o.iterations = 0; });
    wrong("find_orbit_simulation_options",
          [] { keep(find_orbit(System(calm_oscillator()), by_phase(), {}, {.tolerance = not_a_number})); });
    wrong("find_orbit_of_two_graphs_model", [] {
        Model model = calm_oscillator();
        model.states.clear();
        keep(find_orbit(System(model), by_phase()));
    });
    wrong("half_orbit_tolerance", negative(),
          [](double v) { keep(half_orbit(System(symmetric_oscillator()), calm_orbit(), v)); });
    const auto search = [&](const std::string& name, const SignatureSearchOptions& limits) {
        wrong("signature_search_" + name, [limits] {
            keep(orbit_with_signature(System(calm_oscillator()), parse_signature(oscillator(), "phase0"), {}, {},
                                      limits));
        });
    };
    search("no_steps", {.steps = 0});
    search("no_segments", {.segments = 0});
    search("no_trials", {.trials = 0});
}

void motions(WrongUses& wrong) {
    struct Given {
        std::vector<double> parameters = oscillator().parameter_values(), state = oscillator().initial_state();
        std::size_t mode = 0;
        double time = 1;
    };
    const auto motion =
        wrong.spoiled<Given>([] { return Given(); }, {{"follow_motion", [](Given& g) {
                                                           keep(follow_motion(Simulation(System(oscillator())),
                                                                              g.parameters, g.state, g.mode, g.time));
                                                       }}});
    motion("parameters", wrong_lengths(5), [](Given& g, std::size_t n) { g.parameters.resize(n); });
    motion("state", wrong_lengths(3), [](Given& g, std::size_t n) { g.state.resize(n); });
    motion("parameter", not_finite(), [](Given& g, double v) { g.parameters[0] = v; });
    motion("state", not_finite(), [](Given& g, double v) { g.state[0] = v; });
    motion("time", not_finite(), [](Given& g, double v) { g.time = v; });
    motion("time_negative", [](Given& g) { g.time = -1; });
    motion("mode", wrong_indices(2), [](Given& g, std::size_t i) { g.mode = i; });
    for (const std::string table : {"", "t,x,v,theta\n", "segment,t,x,v\n1,0,0,0\n", "segment,t,x,v,theta\n",
                                    "segment,t,x,v,theta\n1,0,0,0,0\n", "segment,t,x,v,theta\n1,0,0,0,0\n1,nan,0,0,0\n",
                                    "segment,t,x,v,theta\n1,1,0,0,0\n1,0,0,0,0\n", "segment,t,x,v,theta\n2,0,0,0,0\n",
                                    "segment,t,x,v,theta\n1,0,0\n", "segment,segment,t,x,v,theta\n1,1,0,0,0,0\n",
                                    "segment,t,x,v,theta,end\n1,0,0,0,0,unknown\n1,1,0,0,0,unknown\n", "\xff"}) {
        wrong("parse_orbit_table", [table] { keep(parse_orbit_table(oscillator(), table, "", "file.csv")); });
        wrong("parse_orbit_table_signature",
              [table] { keep(parse_orbit_table(oscillator(), table, "unknown", "file.csv")); });
    }
    wrong("read_orbit_table_no_file", [] { keep(read_orbit_table(oscillator(), "/no/such/file", "impact")); });
    wrong("read_orbit_table_folder", [] { keep(read_orbit_table(oscillator(), "/tmp", "impact")); });
    wrong("name_of_no_orbit_outcome", [] { keep(std::string(name_of(static_cast<OrbitOutcome>(99)))); });
}

TEST(WrongOrbitUse, IsRefused) {
    expect_refusals({defective_orbits, signatures, wrong_orbit_options, motions});
}

} // namespace graze::orbit_misuse_test
