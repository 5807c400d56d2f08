// Wrong uses of continuation, branches, monitors and special points.

#include "misuse/valid_objects.hpp"
#include "misuse/wrong_use.hpp"

// Omitted members of a struct have the defaults of its header.
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

namespace graze::branch_misuse_test {

using Values = std::vector<double>;

using namespace graze::testing;

/// A circle.
bool residual(std::span<const double> u, std::span<double> values) {
    values[0] = u[0] * u[0] + u[1] * u[1] - 1;
    return true;
}
struct Circle {
    DenseProblem problem{2, residual};
    Continuation continuation{borrowed(problem)};
    const std::vector<double> point = {1, 0};
    Circle& evaluated() {
        problem.evaluate(point);
        return *this;
    }
    void solve(std::size_t row, std::size_t step) {
        Values result(step);
        keep(problem.solve(Values(row, 1.0), 0, false, result, nullptr));
    }
    Continuation& started() {
        EXPECT_TRUE(continuation.start(point, 1, 1));
        return continuation;
    }
};

void problems(WrongUses& wrong) {
    wrong("continuation_without_problem", [] { Continuation({}); });
    wrong("dense_problem_no_unknowns", [] { keep(DenseProblem(0, residual)); });
    wrong("dense_problem_unknowns_huge", [] { keep(DenseProblem(huge, residual)); });
    wrong("dense_problem_without_residuals", [] { keep(DenseProblem(2, {})); });
    for (const std::size_t length : {1, 3})
        wrong("dense_problem_scales_" + std::to_string(length),
              [length] { keep(DenseProblem(2, residual, {}, std::vector<double>(length, 1.0))); });
    wrong("dense_problem_scale", not_positive(), [](double v) { keep(DenseProblem(2, residual, {}, {1, v})); });
    wrong("dense_evaluate", wrong_lengths(2),
          [](std::size_t n) { keep(Circle().problem.evaluate(std::vector<double>(n, 1.0))); });
    wrong("dense_solve_row", wrong_lengths(2), [](Circle& c, std::size_t n) { c.evaluated().solve(n, 2); });
    wrong("dense_solve_step", wrong_lengths(2), [](Circle& c, std::size_t n) { c.evaluated().solve(2, n); });
    wrong("dense_solve_before_evaluate", [](Circle& c) { c.solve(2, 2); });
}

void continuations(WrongUses& wrong) {
    using Options = ContinuationOptions;
    const auto option = wrong.spoiled<Options>(
        [] { return Options(); },
        {{"continuation_options", &Options::validate},
         {"continuation_with",
          [](Options& options) { Continuation(std::make_shared<DenseProblem>(2, residual), options); }},
         {"branch_settings_continuation", [](Options& options) {
              BranchSettings settings = by_amplitude();
              settings.continuation = options;
              settings.validate(oscillator());
          }}});
    const std::vector<std::pair<std::string, double ContinuationOptions::*>> members = {
        {"first_step", &ContinuationOptions::first_step},
        {"smallest_step", &ContinuationOptions::smallest_step},
        {"largest_step", &ContinuationOptions::largest_step},
        {"accuracy", &ContinuationOptions::accuracy},
        {"largest_angle", &ContinuationOptions::largest_angle}};
    for (const auto& [name, member] : members)
        for (const auto& [kind, value] : not_positive())
            option(name + "_" + kind, [m = member, v = value](ContinuationOptions& o) { o.*m = v; });
    option("iterations_0", [](ContinuationOptions& o) { o.iterations = 0; });
    option("smallest_step_above_largest", [](ContinuationOptions& o) { o.smallest_step = 1; });

    const auto of = [&](const std::string& name, const auto&... use) { wrong("continuation_" + name, use...); };
    of("start_u", wrong_lengths(2), [](Circle& c, std::size_t n) { keep(c.continuation.start(Values(n, 1.0), 0, 1)); });
    of("along_u", wrong_lengths(2), [](Circle& c, std::size_t n) {
        keep(c.continuation.start_along(Values(n, 1.0), Values{0, 1}, 0.1));
    });
    of("along_direction", wrong_lengths(2),
       [](Circle& c, std::size_t n) { keep(c.continuation.start_along(c.point, Values(n, 1.0), 0.1)); });
    of("at_u", wrong_lengths(2), [](Circle& c, std::size_t n) {
        keep(c.continuation.start_at(Values(n, 1.0), Values{0, 1}));
    });
    of("at_row", wrong_lengths(2),
       [](Circle& c, std::size_t n) { keep(c.continuation.start_at(c.point, Values(n, 1.0))); });
    of("start_unknown", wrong_indices(2), [](Circle& c, std::size_t i) { keep(c.continuation.start(c.point, i, 1)); });
    of("start_direction_0", [](Circle& c) { keep(c.continuation.start(c.point, 1, 0)); });
    of("start", not_finite(), [](Circle& c, double v) { keep(c.continuation.start(Values{1, v}, 1, 1)); });
    of("along", not_finite(), [](Circle& c, double v) {
        keep(c.continuation.start_along(Values{1, v}, Values{0, 1}, 0.1));
    });
    of("along_direction", not_finite(), [](Circle& c, double v) {
        keep(c.continuation.start_along(c.point, Values{0, v}, 0.1));
    });
    of("along_distance", not_finite(), [](Circle& c, double v) {
        keep(c.continuation.start_along(c.point, Values{0, 1}, v));
    });
    of("at", not_finite(), [](Circle& c, double v) { keep(c.continuation.start_at(Values{1, v}, Values{0, 1})); });
    of("at_row", not_finite(), [](Circle& c, double v) { keep(c.continuation.start_at(c.point, Values{0, v})); });
    of("between", not_finite(), [](Circle& c, double v) {
        c.started().step();
        ContinuationPoint point;
        keep(c.continuation.between(v, point));
    });
    of("along_direction_zero", [](Circle& c) { keep(c.continuation.start_along(c.point, Values{0, 0}, 0.1)); });
    of("along_distance_negative", [](Circle& c) { keep(c.continuation.start_along(c.point, Values{0, 1}, -1)); });
    of("at_row_zero", [](Circle& c) { keep(c.continuation.start_at(c.point, Values{0, 0})); });
    of("step_before_start", [](Circle& c) { keep(c.continuation.step()); });
    of("next_step", not_positive(), [](Circle& c, double v) { c.started().set_next_step(v); });
    of("next_step_before_start", not_positive(), [](Circle& c, double v) { c.continuation.set_next_step(v); });
    for (const double fraction : {-1.0, 2.0})
        of("between_" + std::to_string(fraction), [fraction](Circle& c) {
            c.started().step();
            ContinuationPoint point;
            keep(c.continuation.between(fraction, point));
        });
    of("between_before_start", [](Circle& c) {
        ContinuationPoint point;
        keep(c.continuation.between(0.5, point));
    });
    of("between_before_step", [](Circle& c) {
        ContinuationPoint point;
        keep(c.started().between(0.5, point));
    });
    wrong("name_of_no_continuation_outcome", [] { keep(std::string(name_of(static_cast<ContinuationOutcome>(99)))); });
}

void settings(WrongUses& wrong) {
    const auto setting = wrong.spoiled<BranchSettings>(
        by_amplitude,
        {{"branch_settings", [](BranchSettings& s) { s.validate(oscillator()); }},
         {"orbit_branch", [](BranchSettings& s) { keep(OrbitBranch(System(calm_oscillator()), calm_orbit(), s)); }},
         {"branches_at", [](BranchSettings& s) { keep(branches_at(System(calm_oscillator()), grazing_point(), s)); }}});
    setting("parameter", wrong_indices(5), [](BranchSettings& s, std::size_t i) { s.parameter = ParameterId(i); });
    setting("free", wrong_indices(5), [](BranchSettings& s, std::size_t i) {
        s.monitors = {{.name = "period", .fixed = true}};
        s.free = {ParameterId(i)};
    });
    for (const int direction : {0, 2, -7})
        setting("direction_" + std::to_string(direction), [direction](BranchSettings& s) { s.direction = direction; });
    setting("bounds_reversed", [](BranchSettings& s) {
        s.least = 2;
        s.greatest = 1;
    });
    setting("least_nan", [](BranchSettings& s) { s.least = not_a_number; });
    setting("greatest_nan", [](BranchSettings& s) { s.greatest = not_a_number; });
    setting("free_without_monitor", [](BranchSettings& s) { s.free = {ParameterId(0)}; });
    setting("fixed_monitor_without_free", [](BranchSettings& s) { s.monitors = {{.name = "period", .fixed = true}}; });
    setting("free_is_parameter", [](BranchSettings& s) {
        s.monitors = {{.name = "period", .fixed = true}};
        s.free = {s.parameter};
    });
    setting("stop_at_nothing", [](BranchSettings& s) { s.stop_at = {static_cast<PointType>(99)}; });
    setting("orbit_tolerance", [](BranchSettings& s) { s.orbit.tolerance = not_a_number; });
    setting("steps_0", [](BranchSettings& s) { s.steps = 0; });
    const auto monitor = [&](const std::string& name, const Monitor& one) {
        setting("monitor_" + name, [one](BranchSettings& s) { s.monitors = {one}; });
        wrong("monitors_" + name,
              [one] { keep(OrbitMonitors(System(calm_oscillator()), calm_orbit().signature, {one})); });
    };
    using Kind = Monitor::Kind;
    const Expression x = Graph::create()->symbol("x"), unknown = Graph::create()->symbol("unknown");
    for (const Kind kind : {Kind::value, Kind::start, Kind::maximum, Kind::mean, Kind::norm}) {
        const std::string number = std::to_string(static_cast<int>(kind));
        monitor("of_nothing_" + number, {.name = "m", .kind = kind});
        monitor("of_unknown_" + number, {.name = "m", .kind = kind, .expression = unknown});
    }
    monitor("of_no_kind", {.name = "m", .kind = static_cast<Kind>(99), .expression = x});
    monitor("duration_of_expression", {.name = "m", .kind = Kind::duration, .expression = x});
    for (const std::string segment : {"0", "2", "-1", "99999999999999999999", "unknown", "phase0#2", "phase0#0", "#"})
        monitor("segment_" + segment, {.name = "m", .segment = segment});
    monitor("place_0", {.name = "m", .kind = Kind::multiplier, .place = 0});
    monitor("held_nan", {.name = "m", .held = not_a_number});
    monitor("crossing_nan", {.name = "m", .crossings = {not_a_number}});
    monitor("bounds_reversed", {.name = "m", .least = 1, .greatest = 0});
    wrong("monitors_tolerance", not_positive(), [](double t) {
        keep(OrbitMonitors(System(calm_oscillator()), calm_orbit().signature, {{.name = "period"}}, t));
    });
    wrong("monitors_segment", wrong_indices(1), [](std::size_t i) {
        keep(OrbitMonitors(System(calm_oscillator()), calm_orbit().signature, {{.name = "period"}}).segment(i));
    });
    const auto signature = [&](const std::string& name, const Signature& given) {
        wrong("monitors_set_signature_" + name, [given] {
            OrbitMonitors monitors(System(calm_oscillator()), calm_orbit().signature, {{.name = "period"}});
            monitors.set_signature(given);
        });
    };
    signature("empty", {});
    signature("mode", {{7, SegmentEnd::section, 0}});
    signature("section", {{0, SegmentEnd::section, 7}});
    signature("event", {{0, SegmentEnd::event, 7}});
    wrong("moved_monitors", [] {
        OrbitMonitors monitors(System(calm_oscillator()), calm_orbit().signature, {{.name = "period"}});
        const OrbitMonitors moved = std::move(monitors);
        keep(monitors(calm_orbit()));
    });
    wrong("measure_multipliers", wrong_lengths(2), [](std::size_t n) {
        std::vector<double> values(n);
        measure_multipliers({{.name = "a", .kind = Kind::multiplier}, {.name = "b", .kind = Kind::multiplier}},
                            {1.0, 0.5}, values);
    });
    wrong("measure_multipliers_place_0", [] {
        std::vector<double> values(1);
        measure_multipliers({{.name = "a", .kind = Kind::multiplier, .place = 0}}, {1.0}, values);
    });
}

void branches(WrongUses& wrong) {
    const auto branch =
        wrong.spoiled<OrbitBranch>([] { return OrbitBranch(System(calm_oscillator()), calm_orbit(), by_amplitude()); },
                                   {{"orbit_branch", [](OrbitBranch&) {}}});
    branch("step_before_start", [](OrbitBranch& b) { keep(b.step()); });
    branch("point_before_start", [](OrbitBranch& b) { keep(b.point()); });
    const OrbitDirection along{{{0, 0, 0}}, {0}, {1}};
    branch("along_no_direction", [](OrbitBranch& b) { keep(b.start_along({}, 0.01)); });
    for (const std::size_t length : {0, 1, 2, 4}) {
        const std::string count = std::to_string(length);
        branch("along_start_of_" + count, [length](OrbitBranch& b) {
            keep(b.start_along({{Values(length, 1.0)}, {0}, {1}}, 0.01));
        });
        if (length == 1)
            continue;
        branch("along_starts_of_" + count, [length](OrbitBranch& b) {
            keep(b.start_along({std::vector(length, Values{0, 0, 0}), {0}, {1}}, 0.01));
        });
        branch("along_durations_of_" + count, [length](OrbitBranch& b) {
            keep(b.start_along({{{0, 0, 0}}, Values(length, 0.0), {1}}, 0.01));
        });
    }
    branch("along_no_parameter", [](OrbitBranch& b) { keep(b.start_along({{{0, 0, 0}}, {0}, {}}, 0.01)); });
    branch("along_two_parameters", [](OrbitBranch& b) { keep(b.start_along({{{0, 0, 0}}, {0}, {1, 1}}, 0.01)); });
    branch("along_start", not_finite(), [](OrbitBranch& b, double v) {
        keep(b.start_along({{{0, v, 0}}, {0}, {1}}, 0.01));
    });
    branch("along_duration", not_finite(), [](OrbitBranch& b, double v) {
        keep(b.start_along({{{0, 0, 0}}, {v}, {1}}, 0.01));
    });
    branch("along_parameter", not_finite(), [](OrbitBranch& b, double v) {
        keep(b.start_along({{{0, 0, 0}}, {0}, {v}}, 0.01));
    });
    branch("along_distance", not_finite(), [along](OrbitBranch& b, double v) { keep(b.start_along(along, v)); });
    branch("along_nothing", [](OrbitBranch& b) { keep(b.start_along({{{0, 0, 0}}, {0}, {0}}, 0.01)); });
    branch("along_distance_negative", [along](OrbitBranch& b) { keep(b.start_along(along, -1)); });
    const auto moved = [&](const std::string& name, const std::function<void(OrbitBranch&)>& use) {
        branch("moved_" + name, [use](OrbitBranch& b) {
            const OrbitBranch taken = std::move(b);
            use(b);
        });
    };
    moved("start", [](OrbitBranch& b) { keep(b.start()); });
    moved("step", [](OrbitBranch& b) { keep(b.step()); });
    moved("point", [](OrbitBranch& b) { keep(b.point().parameter); });
    moved("found", [](OrbitBranch& b) { keep(b.found().size()); });
    moved("outcome", [](OrbitBranch& b) { keep(b.outcome()); });
    wrong("branches_at_default_point", [] { keep(branches_at(System(calm_oscillator()), {}, by_amplitude())); });
    for (int type = 0; type <= static_cast<int>(PointType::regular) + 1; ++type) {
        wrong("branches_at_default_point_of_type_" + std::to_string(type), [type] {
            SpecialPoint point;
            point.type = static_cast<PointType>(type);
            keep(branches_at(System(calm_oscillator()), point, by_amplitude()));
        });
        wrong("branches_at_orbit_without_tangent_of_type_" + std::to_string(type), [type] {
            SpecialPoint point;
            point.type = static_cast<PointType>(type);
            point.solution = calm_solution();
            point.segment = point.event = 7;
            keep(branches_at(System(calm_oscillator()), point, by_amplitude()));
        });
    }
    const auto grazing = wrong.spoiled<SpecialPoint>(
        grazing_point, {{"branches_at_grazing", [](SpecialPoint& point) {
                             keep(branches_at(System(calm_oscillator()), point, by_amplitude()));
                         }}});
    grazing("segment", wrong_indices(1), [](SpecialPoint& p, std::size_t i) { p.segment = i; });
    grazing("event", wrong_indices(2), [](SpecialPoint& p, std::size_t i) { p.event = i; });
    grazing("time", not_finite(), [](SpecialPoint& p, double v) { p.time = v; });
    grazing("time_negative", [](SpecialPoint& p) { p.time = -1; });
    grazing("time_after_the_end", [](SpecialPoint& p) { p.time = 1e6; });
    grazing("signature_empty", [](SpecialPoint& p) { p.solution.orbit.signature.clear(); });
    wrong("branches_at_another_models_point",
          [] { keep(branches_at(System(load_model("mems-switch")), grazing_point(), by_amplitude())); });
    wrong("short_name_of_no_type", [] { keep(std::string(short_name(static_cast<PointType>(99)))); });
    wrong("name_of_no_type", [] { keep(std::string(name_of(static_cast<PointType>(99)))); });
    wrong("name_of_no_branch_outcome", [] { keep(std::string(name_of(static_cast<BranchOutcome>(99)))); });
}

TEST(WrongBranchUse, IsRefused) {
    expect_refusals({problems, continuations, settings, branches});
}

} // namespace graze::branch_misuse_test
