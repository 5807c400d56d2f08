#pragma once

#include "graze/model/catalogue.hpp"
#include "graze/orbit/solve.hpp"
#include "graze/results/result_file.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/study.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
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

class StudyOfEveryKind : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ =
            std::filesystem::temp_directory_path() / ("graze-every-kind-" + std::to_string(getpid()) + "-" +
                                                      ::testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    void write(const std::string& name, const std::string& contents) const { std::ofstream(path(name)) << contents; }

    /// Runs the study, and removes all that it was read from.
    void run_and_forget() const {
        write("study.toml", text_of_every_kind);
        write("model.toml", model_text("impact-oscillator"));
        write("orbit.csv", "segment,t,x,v,theta,end\n" + orbit_rows());
        const Study study = read_study(path("study.toml"));
        ResultFile file(path("results.sqlite"), ResultFile::Access::write);
        for (const RunReport& report : run_study(study, file, {}))
            ASSERT_TRUE(report.complete()) << report.name << ": " << report.problem;
        for (const char* name : {"study.toml", "model.toml", "orbit.csv"})
            std::filesystem::remove(path(name));
    }

    std::filesystem::path folder_;

private:
    static std::string model_text(const std::string& name) { return std::string(find_in_catalogue(name)->text); }
    /// An orbit with one impact, found by simulation.
    static std::string orbit_rows();
};

inline std::string StudyOfEveryKind::orbit_rows() {
    Model model = load_model("impact-oscillator");
    model.set_parameter("omega", 2.8);
    AttractorOptions settle;
    settle.section = model.sections.front().name;
    const Orbit orbit = find_orbit(System(model), settle).orbit;
    std::string rows;
    double time = 0;
    for (std::size_t s = 0; s < orbit.segments(); ++s) {
        for (const double at : {0.0, orbit.durations[s]}) {
            rows += std::to_string(s + 1) + ',' + std::to_string(time + at);
            for (const double value : orbit.starts[s])
                rows += ',' + std::to_string(value);
            rows += ',' + end_name(model, orbit.signature[s]) + '\n';
        }
        time += orbit.durations[s];
    }
    return rows;
}

} // namespace graze::testing
