// Runs a study into a result file, and reads everything back from that file alone.

#include <graze/picture/result_picture.hpp>
#include <graze/results/stored_run.hpp>
#include <graze/study/runner.hpp>
#include <graze/study/stored_study.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>

using namespace graze;

constexpr const char* study = R"(
name = "onset"
model = "impact-oscillator"
values = ["v"]
[runs.sweep]
kind = "sweep"
vary = { omega = { from = 2.7, to = 2.9, step = 0.05 } }
)";

int main() {
    const std::string path = "onset.sqlite";
    std::filesystem::remove(path);
    ResultFile file(path, ResultFile::Access::write);
    run_study(parse_study(study, "onset.toml"), file, {});

    const StoredRun sweep(file, "sweep", {});
    auto rows = sweep.rows({.samples = true, .columns = {"label"}, .quantities = {"omega"}, .values = {"v"}});
    double greatest = 0;
    while (rows.next())
        greatest = rows.text(0) == "periodic" ? std::max(greatest, rows.number(2)) : greatest;
    std::printf("%zu points; no periodic orbit meets the section at a speed above %.3f\n", sweep.points(), greatest);

    const Study again = stored_study(file);
    for (const RunReport& report : run_study(again, file, {}))
        std::printf("%s: %zu points computed again\n", report.name.c_str(), report.computed);
    const Figure figure = make_picture(default_picture(sweep.record), file).figure;
    std::printf("a picture of %zu dots\n", figure.panels.front().series.front().points.size());
    return 0;
}
