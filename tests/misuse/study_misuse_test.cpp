// Wrong uses of result files, their contents, and studies.

#include "base/temporary_folder.hpp"
#include "misuse/valid_objects.hpp"
#include "misuse/wrong_use.hpp"

#include "graze/record/spectrum.hpp"
#include "graze/results/hdf5.hpp"
#include "graze/results/regression.hpp"
#include "graze/results/result_file.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/study_catalogue.hpp"

namespace graze::study_misuse_test {

using namespace graze::testing;

/// A folder with a result file that contains a branch and a sweep of four points with two states, coordinates and
/// values.
struct Results {
    TemporaryFolder folder;
    std::unique_ptr<ResultFile> file = std::make_unique<ResultFile>(path(), ResultFile::Access::write);
    Results() { file->begin_run(sweep()); }
    std::string path(const std::string& name = "results.sqlite") const { return folder / name; }
    static RunRecord sweep() {
        RunRecord run;
        run.name = "sweep";
        run.kind = "sweep";
        run.model_name = "oscillator";
        run.model = write_model(oscillator());
        run.settings = "{}";
        run.fingerprint = "abc";
        run.version = "0.1.0";
        run.coordinates = {{"amplitude", ""}, {"omega", ""}};
        run.states = {{"x", ""}, {"v", ""}, {"theta", ""}};
        run.values = {{"x", ""}, {"v", ""}};
        run.samplings = {"phase0"};
        run.modes = {"free", "stuck"};
        run.directions = {"up"};
        run.points = 4;
        return run;
    }
    static RunRecord branch() {
        RunRecord run = sweep();
        run.name = "branch";
        run.kind = "continue";
        run.coordinates.clear();
        for (const std::string& name : oscillator().independent_parameters())
            run.coordinates.push_back({name, ""});
        run.values.clear();
        return run;
    }
    static PointRecord point() {
        PointRecord record;
        record.coordinates = {1, 2};
        record.result.state = {0, 0, 0};
        record.result.samples = {.width = 2, .samplings = {0}, .times = {1}, .values = {1, 2}};
        return record;
    }
    static OrbitRecord orbit() {
        OrbitRecord record;
        record.part = "up";
        record.point.type = PointType::regular;
        record.point.solution = calm_solution();
        return record;
    }
};

void result_files(WrongUses& wrong) {
    const auto of = [&](const std::string& name, const auto& use) { wrong("results_" + name, use); };
    using Access = ResultFile::Access;
    of("second_writer", [](Results& r) { ResultFile(r.path(), Access::write); });
    of("read_no_file", [](Results& r) { ResultFile(r.path("none"), Access::read); });
    of("read_folder", [](Results& r) { ResultFile(r.folder.path(), Access::read); });
    of("write_in_no_folder", [](Results& r) { ResultFile(r.path("none/none"), Access::write); });
    for (const Access access : {Access::read, Access::write}) {
        const std::string number = std::to_string(static_cast<int>(access));
        of("empty_path_" + number, [access](Results&) { ResultFile("", access); });
        of("memory_" + number, [access](Results&) { ResultFile(":memory:", access); });
        of("text_file_" + number, [access](Results& r) {
            ResultFile(r.folder.write("text", "this is no such file, however long it may be"), access);
        });
    }
    const auto reading = [&](const std::string& name, const std::function<void(ResultFile&)>& use) {
        of("write_to_read_only_" + name, [use](Results& r) {
            r.file->flush();
            ResultFile file(r.path(), Access::read);
            use(file);
            file.flush();
        });
    };
    reading("begin_run", [](ResultFile& f) { f.begin_run(Results::sweep()); });
    reading("remove_run", [](ResultFile& f) { f.remove_run("sweep"); });
    reading("add_point", [](ResultFile& f) { f.add_point("sweep", Results::point()); });
    reading("complete_run", [](ResultFile& f) { f.complete_run("sweep"); });
    const auto begin = wrong.spoiled<RunRecord>(
        Results::sweep, {{"results_begin_run", [](RunRecord& run) { Results().file->begin_run(run); }}});
    begin("by_default", [](RunRecord& run) { run = {}; });
    begin("without_name", [](RunRecord& run) { run.name = ""; });
    begin("name_of_folder", [](RunRecord& run) { run.name = "../x"; });
    begin("of_no_kind", [](RunRecord& run) { run.kind = "unknown"; });
    begin("settings_no_json", [](RunRecord& run) { run.settings = "{"; });
    begin("column_twice", [](RunRecord& run) { run.coordinates = {{"a", ""}, {"a", ""}}; });
    begin("column_without_name", [](RunRecord& run) { run.coordinates = {{"", ""}}; });
    of("remove_unknown", [](Results& r) { r.file->remove_run("unknown"); });
    of("complete_unknown", [](Results& r) { r.file->complete_run("unknown"); });
    of("point_count_unknown", [](Results& r) { keep(r.file->point_count("unknown")); });
    of("last_points_unknown", [](Results& r) { keep(r.file->last_points("unknown", 2)()); });
    of("last_points_of_empty_chains", [](Results& r) { keep(r.file->last_points("sweep", 0)()); });
    of("point_unknown", [](Results& r) { keep(r.file->point("unknown", 0)); });
    of("nearest_unknown", [](Results& r) { keep(r.file->nearest_point("unknown", "amplitude", 1, {})); });
    of("nearest_coordinate_unknown", [](Results& r) { keep(r.file->nearest_point("sweep", "unknown", 1, {})); });
    of("nearest_direction_unknown", [](Results& r) { keep(r.file->nearest_point("sweep", "amplitude", 1, 7)); });
    of("nearest_to_nan", [](Results& r) { keep(r.file->nearest_point("sweep", "amplitude", not_a_number, {})); });
    of("orbits_unknown", [](Results& r) { keep(r.file->orbits("unknown", false)); });
    of("orbits_of_sweep", [](Results& r) { keep(r.file->orbits("sweep", false)); });
    of("orbit_unknown", [](Results& r) { keep(r.file->orbit("unknown", 0)); });
    const auto point = wrong.spoiled<PointRecord>(Results::point, {{"results_add_point", [](PointRecord& record) {
                                                                        const Results r;
                                                                        r.file->add_point("sweep", record);
                                                                        r.file->flush();
                                                                        keep(r.file->point("sweep", record.number));
                                                                    }}});
    of("add_point_to_unknown", [](Results& r) { r.file->add_point("unknown", Results::point()); });
    of("add_point_to_branch", [](Results& r) {
        r.file->begin_run(Results::branch());
        r.file->add_point("branch", Results::point());
    });
    of("add_point_twice", [](Results& r) {
        r.file->add_point("sweep", Results::point());
        r.file->add_point("sweep", Results::point());
    });
    point("coordinates", wrong_lengths(2), [](PointRecord& p, std::size_t n) { p.coordinates.resize(n); });
    point("values", wrong_lengths(2), [](PointRecord& p, std::size_t n) { p.result.samples.values.resize(n); });
    point("state", wrong_lengths(3), [](PointRecord& p, std::size_t n) { p.result.state.resize(n); });
    point("samplings", wrong_lengths(1), [](PointRecord& p, std::size_t n) { p.result.samples.samplings.resize(n); });
    point("width", [](PointRecord& p) { p.result.samples.width = 3; });
    point("mode", wrong_indices(2), [](PointRecord& p, std::size_t i) { p.result.mode = i; });
    point("direction", wrong_indices(1), [](PointRecord& p, std::size_t i) { p.direction = i; });
    point("sampling", wrong_indices(1), [](PointRecord& p, std::size_t i) { p.result.samples.samplings = {i}; });
    point("number", wrong_indices(4), [](PointRecord& p, std::size_t i) { p.number = i; });
    point("no_label", [](PointRecord& p) { p.result.label = static_cast<Label>(99); });
    const auto orbit = wrong.spoiled<OrbitRecord>(Results::orbit, {{"results_add_orbit", [](OrbitRecord& record) {
                                                                        const Results r;
                                                                        r.file->begin_run(Results::branch());
                                                                        r.file->add_orbit("branch", record);
                                                                        r.file->flush();
                                                                        keep(r.file->orbits("branch", false));
                                                                    }}});
    of("add_orbit_to_unknown", [](Results& r) { r.file->add_orbit("unknown", Results::orbit()); });
    of("add_orbit_to_sweep", [](Results& r) { r.file->add_orbit("sweep", Results::orbit()); });
    orbit("by_default", [](OrbitRecord& o) { o = {}; });
    orbit("no_type", [](OrbitRecord& o) { o.point.type = static_cast<PointType>(99); });
    orbit("monitors_too_many", [](OrbitRecord& o) { o.point.monitors = {1}; });
    orbit("parameters_missing", [](OrbitRecord& o) { o.point.solution.orbit.parameters.clear(); });
    orbit("starts_missing", [](OrbitRecord& o) { o.point.solution.orbit.starts.clear(); });
    orbit("start_too_short", [](OrbitRecord& o) { o.point.solution.orbit.starts[0].pop_back(); });
    orbit("durations_missing", [](OrbitRecord& o) { o.point.solution.orbit.durations.clear(); });
    orbit("mode_huge", [](OrbitRecord& o) { o.point.solution.orbit.signature[0].mode = huge; });
    orbit("index_huge", [](OrbitRecord& o) { o.point.solution.orbit.signature[0].index = huge; });
    orbit("approach_speeds_missing", [](OrbitRecord& o) { o.point.solution.certificate.approach_speeds.clear(); });
}

void rows(WrongUses& wrong) {
    const auto row = [&](const std::string& name, const std::function<void(ResultFile::Rows&)>& use) {
        wrong("rows_" + name, [use](Results& results) {
            ResultFile::Rows one = results.file->query("select name, points from runs");
            use(one);
        });
    };
    using Rows = ResultFile::Rows;
    const std::vector<std::pair<std::string, std::function<void(const Rows&, std::size_t)>>> readers = {
        {"is_null", [](const Rows& r, std::size_t i) { keep(r.is_null(i)); }},
        {"is_text", [](const Rows& r, std::size_t i) { keep(r.is_text(i)); }},
        {"is_integer", [](const Rows& r, std::size_t i) { keep(r.is_integer(i)); }},
        {"number", [](const Rows& r, std::size_t i) { keep(r.number(i)); }},
        {"integer", [](const Rows& r, std::size_t i) { keep(r.integer(i)); }},
        {"text", [](const Rows& r, std::size_t i) { keep(r.text(i)); }}};
    for (const auto& [name, read] : readers) {
        row(name + "_before_next", [read = read](Rows& r) { read(r, 0); });
        row(name + "_after_the_last", [read = read](Rows& r) {
            while (r.next()) {
            }
            read(r, 0);
        });
        for (const auto& [kind, index] : wrong_indices(2))
            row(name + "_column_" + kind, [read = read, i = index](Rows& r) {
                r.next();
                read(r, i);
            });
        row(name + "_moved", [read = read](Rows& r) {
            r.next();
            const Rows moved = std::move(r);
            read(r, 0);
        });
    }
    for (const auto& [kind, index] : wrong_indices(2))
        row("column_name_" + kind, [i = index](Rows& r) { keep(r.column_name(i)); });
    row("moved_next", [](Rows& r) {
        const Rows moved = std::move(r);
        keep(r.next());
    });
    row("moved_columns", [](Rows& r) {
        const Rows moved = std::move(r);
        keep(r.columns());
    });
    row("number_of_a_text", [](Rows& r) {
        r.next();
        keep(r.number(0));
    });
    for (const std::string sql : {"", "  ", "garbage", "select", "select * from unknown", "delete from runs",
                                  "select 1; select 2", "pragma journal_mode=delete", "attach 'x' as y", "select ?1"})
        wrong("query_" + sql, [sql](Results& results) { keep(results.file->query(sql).next()); });
    wrong("query_values_too_many", [] { keep(Results().file->query("select ?1", {1, 2}).next()); });
    wrong("patience_negative", [] { Results().file->set_patience(std::chrono::milliseconds(-1)); });
    wrong("stored_model_of_nothing", [] { keep(stored_model({})); });
    wrong("stored_model_of_other_columns", [] {
        RunRecord run = Results::sweep();
        run.states.pop_back();
        keep(stored_model(run));
    });
    for (const std::string path : {"", "/no/such/folder/file.h5", "/tmp"})
        wrong("export_hdf5_to_" + path, [path] { export_hdf5(*Results().file, {"sweep"}, path); });
    wrong("export_hdf5_unknown",
          [](Results& results) { export_hdf5(*results.file, {"unknown"}, results.path("a.h5")); });
    wrong("export_hdf5_twice", [](Results& results) {
        export_hdf5(*results.file, {"sweep", "sweep"}, results.path("a.h5"));
    });
    wrong("export_hdf5_over_its_own_source",
          [](Results& results) { export_hdf5(*results.file, {"sweep"}, results.path()); });
    wrong("spectrum_of_nothing", [] { keep(spectrum({}, 1)); });
    wrong("spectrum_frequency", not_positive(), [](double v) { keep(spectrum(std::vector<double>{1, 2, 3, 4}, v)); });
    wrong("spectrum_sample", not_finite(), [](double v) { keep(spectrum(std::vector<double>{1, v, 3, 4}, 1)); });
    wrong("regression", not_finite(), [](double v) { keep(regression(std::vector{1.0, v}, std::vector{1.0, 2.0})); });
    wrong("regression_y", not_finite(), [](double v) { keep(regression(std::vector{1.0, 2.0}, std::vector{1.0, v})); });
    wrong("regression_x", wrong_lengths(3), [](std::size_t n) {
        keep(regression(std::vector(n, 1.0), std::vector{1.0, 2.0, 3.0}));
    });
    wrong("regression_y", wrong_lengths(3), [](std::size_t n) {
        keep(regression(std::vector{1.0, 2.0, 3.0}, std::vector(n, 1.0)));
    });
}

/// A study with one run of two motions, and what it is run with.
struct OneRun {
    Study study;
    std::unique_ptr<Results> results = std::make_unique<Results>();
    RunnerOptions options;
    OneRun() {
        study.name = "study";
        StudyRun& one = study.runs.emplace_back();
        one.name = "a";
        one.model = oscillator();
        one.motion().transient.time = 0.1;
        one.motion().axes = {{.name = "amplitude",
                              .unit = "",
                              .parameter = oscillator().independent_parameter("amplitude"),
                              .values = {0.5, 1}}};
    }
    void run() {
        for (const RunReport& report : run_study(study, *results->file, options))
            if (report.outcome == RunOutcome::failed)
                throw InputError(report.problem, report.remedy);
    }
};

void studies(WrongUses& wrong) {
    for (const std::string text : {"", "garbage", "name = 'a'", "name = 'a'\n[runs.a]\n", "name = 1", "[", "\xff",
                                   "name = 'a'\n[runs.a]\nkind = 'unknown'\nmodel = 'mems-switch'\n"})
        wrong("parse_study_" + text, [text] { keep(parse_study(text, "study.toml")); });
    for (const std::string name : {"", "unknown", "/no/such.toml", "/tmp/", "mems-switch.toml"}) {
        wrong("load_study_" + name, [name] { keep(load_study(name)); });
        wrong("read_study_" + name, [name] { keep(read_study(name)); });
        wrong("shipped_study_text_" + name, [name] { keep(shipped_study_text(name)); });
    }
    wrong("name_of_no_run_kind", [] { keep(std::string(name_of(static_cast<RunKind>(99)))); });
    const auto run = wrong.spoiled<OneRun>([] { return OneRun(); }, {{"run_study", &OneRun::run}});
    for (const int jobs : {0, -1})
        run("jobs_" + std::to_string(jobs), [jobs](OneRun& r) { r.options.jobs = jobs; });
    run("only_unknown", [](OneRun& r) { r.options.only = {"unknown"}; });
    run("read_only", [](OneRun& r) {
        r.results->file = nullptr;
        r.results->file = std::make_unique<ResultFile>(r.results->path(), ResultFile::Access::read);
    });
    run("run_by_default", [](OneRun& r) { r.study.runs[0] = {}; });
    run("run_twice", [](OneRun& r) { r.study.runs.push_back(r.study.runs[0]); });
    run("run_of_no_kind", [](OneRun& r) { r.study.runs[0].kind = static_cast<RunKind>(99); });
    run("start_unknown", [](OneRun& r) { r.study.runs[0].start.emplace().run = "unknown"; });
    run("values_without_names", [](OneRun& r) { r.study.runs[0].values = {r.study.runs[0].model.symbol("x")}; });
    run("value_of_nothing", [](OneRun& r) {
        r.study.runs[0].values.resize(1);
        r.study.runs[0].value_names = r.study.runs[0].value_units = {"a"};
    });
    run("axis_parameter", wrong_indices(5),
        [](OneRun& r, std::size_t i) { r.study.runs[0].motion().axes[0].parameter = ParameterId(i); });
    run("axis_state", wrong_indices(oscillator().states.size()),
        [](OneRun& r, std::size_t i) { r.study.runs[0].motion().axes[0].state = i; });
    run("axis_of_another_name", [](OneRun& r) { r.study.runs[0].motion().axes[0].name = "omega"; });
    run("axis_nan", [](OneRun& r) { r.study.runs[0].motion().axes[0].values = {not_a_number}; });
    run("axis_without_values", [](OneRun& r) { r.study.runs[0].motion().axes[0].values.clear(); });
    run("no_end", [](OneRun& r) { r.study.runs[0].motion().transient = {}; });
    wrong("plan_of_default_run", [] { keep(plan_of({}, System(oscillator()), nullptr)); });
    StudyRun one;
    one.motion().axes = {{.name = "amplitude", .unit = "", .values = {0.5}}};
    wrong("coordinates_of_point", wrong_indices(1), [one](std::size_t i) { keep(coordinates_of(one, i)); });
    wrong("direction_of_point", wrong_indices(1), [one](std::size_t i) { keep(direction_of(one, i)); });
}

TEST(WrongStudyUse, IsRefused) {
    expect_refusals({result_files, rows, studies});
}

} // namespace graze::study_misuse_test
