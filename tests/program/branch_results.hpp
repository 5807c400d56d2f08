#pragma once

#include "graze/model/model_file.hpp"
#include "graze/results/result_file.hpp"
#include "graze/results/run_kind.hpp"
#include "graze/study/stored_study.hpp"
#include "run_graze.hpp"

#include <complex>
#include <string>
#include <vector>

namespace graze::testing {

/// Results written by hand, so that the expected output is known: a ball that bounces without loss, thrown up with
/// speed 1 under gravity g. It flies for the time 2/g and to the height 1/(2g).
class BranchResults : public ::testing::Test {
protected:
    static constexpr const char* ball = R"(
name = "ball"
time_unit = "s"
[parameters]
w = 1
g = { value = 2, unit = "m/s^2" }
[states]
x = { initial = 0, unit = "m" }
v = { initial = 1, unit = "m/s" }
[modes.flight]
rates = { x = "v", v = "-g" }
watch = ["floor"]
[events.floor]
function = "x"
[jumps.bounce]
v = "-v"
[[transitions]]
mode = "flight"
event = "floor"
label = "bounce"
jump = "bounce"
next = [{ mode = "flight" }]
[quantities]
energy = { value = "v^2/2 + g*x", unit = "m^2/s^2" }
)";

    BranchResults() : path(folder / "results.sqlite"), model(parse_model(ball, "ball.toml")) {}

    RunRecord run_of(const std::string& name, const std::string& kind) const {
        RunRecord run;
        run.name = name;
        run.kind = kind;
        run.model_name = model.name;
        run.model = write_model(model);
        StudyRun asked(run_kind(kind).value());
        asked.name = name;
        asked.model = model;
        run.settings = settings_of(asked);
        run.fingerprint = "f";
        run.version = "test";
        run.coordinates = {{"g", "m/s^2"}, {"w", ""}};
        run.states = {{"x", "m"}, {"v", "m/s"}};
        run.values = {{"height", "m"}, {"period", "s"}};
        return run;
    }
    OrbitRecord orbit_of(const std::string& part, PointType type, double g, bool stable, bool admissible) const {
        OrbitRecord record;
        record.part = part;
        record.stable = stable;
        SpecialPoint& point = record.point;
        point.type = type;
        point.parameter = g;
        point.bracket = {g - 0.1, g + 0.1};
        point.monitors = {1 / (2 * g), 2 / g};
        point.solution.outcome = OrbitOutcome::converged;
        point.solution.residual = 1e-14;
        point.solution.multipliers = {{stable ? 0.5 : -1.5, 0}, {0.25, 0.125}, {0.25, -0.125}};
        point.solution.certificate.admissible = admissible;
        point.solution.certificate.reason = admissible ? "" : "event 'floor' happens within segment 1";
        Orbit& orbit = point.solution.orbit;
        orbit.signature = parse_signature(model, "bounce");
        orbit.parameters = {1, g};
        orbit.starts = {{0, 1}};
        orbit.durations = {2 / g};
        point.solution.certificate.approach_speeds = {1};
        point.solution.certificate.departures = {1};
        return record;
    }
    void write_run(ResultFile& file, const RunRecord& run, std::vector<OrbitRecord> orbits) const {
        file.begin_run(run);
        std::map<PointType, std::size_t> counts;
        for (std::size_t i = 0; i < orbits.size(); ++i) {
            orbits[i].number = i;
            const PointType type = orbits[i].point.type;
            if (type != PointType::regular)
                orbits[i].label = point_label(type, ++counts[type]);
            file.add_orbit(run.name, orbits[i]);
        }
        file.complete_run(run.name);
    }
    /// Writes a branch in two directions, another branch with w = 2, and a single orbit.
    void write_branches() const {
        ResultFile file(path, ResultFile::Access::write);
        write_first(file);
        std::vector<OrbitRecord> others{orbit_of("up", PointType::end, 1, true, true),
                                        orbit_of("up", PointType::grazing, 1.25, true, true)};
        for (OrbitRecord& record : others)
            record.point.solution.orbit.parameters[0] = 2;
        others[1].point.located = false;
        write_run(file, run_of("second", "continue"), others);
        write_run(file, run_of("alone", "orbit"), {orbit_of("", PointType::end, 4, true, true)});
    }
    void write_first(ResultFile& file) const {
        using enum PointType;
        OrbitRecord touch = orbit_of("up", grazing, 1.6, false, true);
        touch.point.detail = "floor";
        touch.point.time = 0.625; // the top
        write_run(file, run_of("first", "continue"),
                  {orbit_of("up", end, 1, true, true), orbit_of("up", regular, 1.5, true, true),
                   orbit_of("up", fold, 2, false, true), orbit_of("up", regular, 1.8, false, true), touch,
                   orbit_of("up", regular, 1.5, false, false), orbit_of("up", end, 1.4, false, false),
                   orbit_of("down", end, 1, true, true), orbit_of("down", flip, 0.9, true, true),
                   orbit_of("down", regular, 0.8, false, true)});
    }
    /// Writes a sweep with one point.
    void write_sweep() const {
        ResultFile file(path, ResultFile::Access::write);
        RunRecord run = run_of("swept", "sweep");
        run.coordinates = {{"g", "m/s^2"}};
        run.values = {{"v", "m/s"}};
        run.samplings = {"section"};
        run.modes = {"flight"};
        run.directions = {"up"};
        run.points = 1;
        file.begin_run(run);
        PointRecord point;
        point.coordinates = {1};
        point.result.label = Label::periodic;
        point.result.period = 1;
        point.result.state = {0, 1};
        point.result.multipliers = {{0.5, 0}};
        point.result.samples.width = 1;
        point.result.samples.samplings = {0};
        point.result.samples.times = {0};
        point.result.samples.values = {1};
        file.add_point(run.name, point);
        file.complete_run(run.name);
    }

    Folder folder;
    std::string path;
    Model model;
};

} // namespace graze::testing
