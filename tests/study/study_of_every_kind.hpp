#pragma once

#include "graze/model/catalogue.hpp"
#include "graze/orbit/solve.hpp"
#include "study/study_fixture.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>

namespace graze::testing {

/// A study with a run of every kind, of a model in a file of its own, from a table in a file.
inline constexpr const char* text_of_every_kind = R"(
name = "all"
text = "one of each kind"
model = "model.toml"
[runs.sweep]
kind = "sweep"
set = { zeta = 0.03 }
vary = { omega = { from = 2.7, to = 2.9, step = 0.02 } }
direction = "both"
cycles = 60
values = ["v", "energy = v^2/2 + x^2/2"]
[runs.sweep.sample]
contacts = { contacts = true }
highest = { maxima = "x" }
[runs.basin]
kind = "basin"
draws = 9
seed = 7
vary = { x = { random = [-1, 0] } }
set = { e = 0.8 }
bounds = { v = [-50, 50] }
cycles = 60
start = { run = "sweep", at = { omega = 2.8 }, direction = "up" }
[runs.motion]
kind = "simulate"
contacts = 20
skip = { time = 1.5 }
[runs.orbit]
kind = "orbit"
set = { omega = 2.8 }
[runs.chain]
kind = "continue"
start = { run = "orbit" }
along = { omega = [2.7, 2.9] }
direction = "both"
monitors = { slowest = { minimum = "v" }, whole = { duration = "period", report = [2.3] }, m = { multiplier = 1 } }
stop = ["GR", "SN"]
[runs.from_table]
kind = "orbit"
set = { omega = 2.8 }
table = "orbit.csv"
[pictures.diagram]
run = "sweep"
y = "v"
samples = "contacts"
x_range = [2.7, 2.8]
names = { v = "velocity", contacts = "at impacts" }
x_label = "frequency, 1"
y_label = "velocity, 1"
size = [85, 60]
font = { name = "Times", size = 8 }
[pictures.chain]
run = "chain"
logarithmic = "x"
[pictures.portrait]
run = "sweep"
kind = "portrait"
at = [{ omega = 2.8 }]
)";

/// A table of the motion along an orbit: both ends of each segment.
inline std::string table_of(const Model& model, const Orbit& orbit) {
    std::string rows = "segment,t,x,v,theta,end\n";
    double time = 0;
    for (std::size_t s = 0; s < orbit.segments(); time += orbit.durations[s++])
        for (const double at : {0.0, orbit.durations[s]})
            rows += fmt::format("{},{:.12g},{:.12g},{}\n", s + 1, time + at, fmt::join(orbit.starts[s], ","),
                                end_name(model, orbit.signature[s]));
    return rows;
}

class StudyOfEveryKind : public StudyFixture {
protected:
    std::string path(const std::string& name) const { return folder_ / name; }
    /// Runs the study, and removes all that it was read from.
    void run_and_forget() const {
        folder_.write("model.toml", std::string(find_in_catalogue("impact-oscillator")->text));
        folder_.write("orbit.csv", table_of_orbit());
        expect_complete(run(text_of_every_kind));
        for (const char* name : {"s.toml", "model.toml", "orbit.csv"})
            std::filesystem::remove(path(name));
    }

private:
    /// Of an orbit with one impact, found by simulation.
    static std::string table_of_orbit() {
        Model model = load_model("impact-oscillator");
        model.set_parameter("omega", 2.8);
        AttractorOptions settle;
        settle.section = model.sections.front().name;
        return table_of(model, find_orbit(System(model), settle).orbit);
    }
};

} // namespace graze::testing
