// Models, studies, designs and other text files with random or malicious changes.

#include "mutated_files.hpp"

namespace graze::testing::mutated_texts_test {

TEST_F(MutatedFiles, ModelsAreUsedOrRefused) {
    const Words texts{source("models/bouncing-ball.toml"), source("models/impact-oscillator.toml"),
                      source("models/dry-friction-oscillator.toml"), source("models/mems-switch.toml"),
                      source("fuzz/corpus/fuzz_model/every_feature")};
    try_texts("m.toml", texts,
              {{{"check", "FILE"}},
               {{"simulate", "FILE", "--time", "1", "--steps", "500", "--samples", "5"}},
               {{"info", "FILE"}},
               {{"simulate", "FILE", "--time", "0.5", "--steps", "200", "--table", "contacts"}}},
              60);
}

TEST_F(MutatedFiles, StudiesAreUsedOrRefused) {
    const Words texts{source("fuzz/corpus/fuzz_study/every_kind"), source("studies/mems-switch.toml"),
                      source("studies/testbed-experiment.toml"), R"(name = "s"
model = "impact-oscillator"
set = { omega = 4 }
[runs.swept]
kind = "sweep"
vary = { omega = { from = 4, to = 4.1, step = 0.1 } }
section = "phase0"
[runs.rest]
kind = "orbit"
from = { x = -0.07 }
[runs.free]
kind = "continue"
direction = "up"
start = { run = "rest" }
along = { omega = [3.9, 4.1] }
steps = 20
[tables.t]
run = "free"
columns = ["omega"]
)"};
    try_texts("s.toml", texts,
              {{{"info", "FILE"}},
               {{"info", "FILE", "--all", "--format", "json"}},
               {{"run", "FILE", "--output", "OUT/r", "--no-pictures", "--jobs", "1"}, true}},
              45);
}

TEST_F(MutatedFiles, DesignsAreUsedOrRefused) {
    try_texts("d.toml", {source("designs/mems-switch-device.toml"), source("designs/mems-switch.toml")},
              {{{"layout", "FILE"}},
               {{"layout", "FILE", "--wafer", "--output", "OUT/w.gds", "--despite-rules"}},
               {{"layout", "FILE", "--recipe", "OUT/r.txt", "--parameters", "OUT/p.toml"}},
               {{"design", "FILE", "--output", "OUT/d", "--no-pictures", "--jobs", "1"}, true},
               {{"layout", "FILE", "--yield", "1", "--folder", "OUT/y", "--jobs", "1"}, true}},
              25);
}

TEST_F(MutatedFiles, ExperimentsAreUsedOrRefused) {
    try_texts("e.toml", {source("fuzz/corpus/fuzz_experiment/sweep.toml")}, {{{"acquire", "FILE", "--dry-run"}}}, 40);
}

TEST_F(MutatedFiles, ParameterFilesAreUsedOrRefused) {
    try_texts("p.toml", {"model = \"bouncing-ball\"\n[set]\ne = 0.5\ngamma = 1\n[from]\nx = 1\nv = 0.5\n"},
              {{{"simulate", "bouncing-ball", "--set", "@FILE", "--time", "1", "--steps", "500"}},
               {{"simulate", "bouncing-ball", "--from", "@FILE", "--time", "1", "--steps", "500"}}},
              20);
}

TEST_F(MutatedFiles, OrbitTablesAreUsedOrRefused) {
    const std::string table = "segment,t,x,v,theta\n1,0,-0.07,0,0\n1,0.5,-0.07,0,1\n1,1.57,-0.07,0,6.28\n";
    const std::string study = folder.write("s.toml", "name = \"s\"\nmodel = \"impact-oscillator\"\n[runs.r]\nkind = "
                                                     "\"orbit\"\nset = { omega = 4 }\ntable = \"o.csv\"\n");
    try_texts("o.csv", {table, source("fuzz/corpus/fuzz_orbit_table/with_signature")},
              {{{"run", study, "--output", "OUT/r", "--no-pictures", "--jobs", "1"}, true}}, 15);
}

} // namespace graze::testing::mutated_texts_test
