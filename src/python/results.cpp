#include "graze/atlas/atlas_tables.hpp"
#include "graze/results/orbit_motion.hpp"
#include "graze/results/result_table.hpp"
#include "graze/results/stored_orbit.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/further_runs.hpp"
#include "graze/study/run_summary.hpp"
#include "graze/study/stored_study.hpp"
#include "python/attended.hpp"
#include "python/tables.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <optional>

namespace graze::python {

namespace {

py::list units_of(const std::vector<ResultColumn>& columns) {
    py::list list;
    for (const ResultColumn& column : columns)
        list.append(py::make_tuple(column.name, column.unit));
    return list;
}

py::dict facts_of_record(const RunRecord& run) {
    py::dict object;
    object["name"] = run.name;
    object["kind"] = run.kind;
    object["model_name"] = run.model_name;
    object["model"] = run.model;
    object["settings"] = run.settings;
    object["fingerprint"] = run.fingerprint;
    object["version"] = run.version;
    object["coordinates"] = units_of(run.coordinates);
    object["states"] = units_of(run.states);
    object["values"] = units_of(run.values);
    object["samplings"] = run.samplings;
    object["modes"] = run.modes;
    object["directions"] = run.directions;
    object["points"] = run.points;
    object["status"] = std::string(name_of(run.status));
    object["failure"] = run.failure;
    return object;
}

py::array_t<std::complex<double>> array_of_multipliers(const std::vector<std::complex<double>>& multipliers) {
    return array_of(multipliers);
}

py::dict facts_of_record(const RunRecord& run, const OrbitRecord& record) {
    const SpecialPoint& point = record.point;
    const OrbitSolution& solution = point.solution;
    py::dict object;
    object["number"] = record.number;
    object["part"] = record.part;
    object["label"] = record.label;
    object["name"] = run.point_name(record.label);
    object["type"] = std::string(short_name(point.type));
    object["type_words"] = std::string(name_of(point.type));
    object["detail"] = point.detail;
    object["stable"] = record.stable;
    object["unphysical"] = is_unphysical(record);
    object["parameter"] = point.parameter;
    object["located"] = point.located;
    object["parameters"] = array_of(solution.orbit.parameters);
    object["monitors"] = array_of(point.monitors);
    object["period"] = solution.orbit.period();
    object["symmetric"] = solution.orbit.symmetry.has_value();
    object["multipliers"] = array_of_multipliers(solution.multipliers);
    object["other_multipliers"] = solution.other_multipliers;
    object["others_within"] = solution.others_within;
    object["half_multipliers"] = array_of_multipliers(solution.half_multipliers);
    object["eigenvalues"] = array_of_multipliers(solution.eigenvalues);
    object["outcome"] = std::string(name_of(solution.outcome));
    object["residual"] = solution.residual;
    object["error"] = solution.error;
    object["admissible"] = solution.certificate.admissible;
    object["reason"] = solution.certificate.reason;
    object["approach_speeds"] = array_of(solution.certificate.approach_speeds);
    object["durations"] = array_of(solution.orbit.durations);
    std::vector<double> starts;
    for (const std::vector<double>& start : solution.orbit.starts)
        starts.insert(starts.end(), start.begin(), start.end());
    std::vector<std::size_t> modes;
    for (const auto& segment : solution.orbit.signature)
        modes.push_back(segment.mode);
    object["modes"] = modes;
    const auto segments = static_cast<py::ssize_t>(solution.orbit.starts.size());
    object["starts"] = array_of(
        starts, {segments, segments == 0 ? 0 : static_cast<py::ssize_t>(solution.orbit.starts.front().size())});
    return object;
}

OrbitRecord orbit_named(const ResultFile& file, const std::string& run, const std::string& point) {
    const auto record = file.find_run(run);
    if (!record)
        throw InputError("there is no run '" + run + "'", "");
    return orbit_of_run(file, *record, point, {});
}

/// The motion along an orbit: for each segment its mode, its end, times and states.
py::list motion_along(const ResultFile& file, const std::string& run, const std::string& point, std::size_t samples) {
    std::vector<SegmentMotion> motion;
    Model model;
    {
        const Unlocked unlocked;
        const OrbitRecord record = orbit_named(file, run, point);
        model = stored_model(*file.find_run(run));
        motion = orbit_motion(model, record.point.solution.orbit, samples);
    }
    py::list list;
    for (SegmentMotion& segment : motion) {
        std::vector<double> states;
        for (const std::vector<double>& state : segment.states)
            states.insert(states.end(), state.begin(), state.end());
        py::dict object;
        object["mode"] = model.modes[segment.mode].name;
        object["end"] = segment.end;
        const auto rows = static_cast<py::ssize_t>(segment.times.size());
        object["times"] = array_of(std::move(segment.times));
        object["states"] = array_of(std::move(states), {rows, static_cast<py::ssize_t>(model.states.size())});
        object["problem"] = segment.problem;
        list.append(object);
    }
    return list;
}

/// The covariance matrix of the estimates of a run: not a number where one is not known.
py::array_t<double> covariance_of(const ResultFile& file, const std::string& run) {
    EstimateRecords found = file.estimates(run);
    const std::size_t count = found.numbers.size();
    if (found.covariance.empty()) {
        found.covariance.assign(count * count, std::numeric_limits<double>::quiet_NaN());
        for (std::size_t i = 0; i < count; ++i)
            if (const Estimate& one = found.numbers[i].estimate; one.freedom > 0)
                found.covariance[i * count + i] = one.error * one.error;
    }
    const auto side = static_cast<py::ssize_t>(count);
    return array_of(std::move(found.covariance), {side, side});
}

/// What is told of a run when it has ended, from its results.
py::dict summary_of_run(const ResultFile& file, const std::string& run) {
    const auto record = file.find_run(run);
    if (!record)
        throw InputError("there is no run '" + run + "'", "");
    RunReport report;
    report.name = run;
    report.kind = record->kind;
    const RunSummary summary = summary_of(report, file);
    py::dict object;
    object["labels"] = summary.labels;
    object["ends"] = summary.ends;
    object["escapes"] = summary.escapes;
    return object;
}

} // namespace

void bind_results(py::module_& module) {
    py::class_<ResultFile, std::shared_ptr<ResultFile>>(module, "ResultFile")
        .def(py::init([](const std::string& path, bool write) {
                 return std::make_shared<ResultFile>(path,
                                                     write ? ResultFile::Access::write : ResultFile::Access::read);
             }),
             py::arg("path"), py::kw_only(), py::arg("write"))
        .def_property_readonly("path", [](const ResultFile& self) { return self.path(); })
        .def("runs",
             [](const ResultFile& self) {
                 py::list list;
                 for (const RunRecord& run : self.runs())
                     list.append(facts_of_record(run));
                 return list;
             })
        .def(
            "run",
            [](const ResultFile& self, const std::string& name) {
                const auto run = self.find_run(name);
                return run ? py::object(facts_of_record(*run)) : py::none();
            },
            py::arg("name"))
        .def("count", &ResultFile::point_count, py::arg("run"))
        .def("names",
             [](const ResultFile& self) {
                 std::vector<std::string> names;
                 for (const RunRecord& run : self.runs())
                     names.push_back(run.name);
                 return names;
             })
        .def("summary", &summary_of_run, py::arg("run"))
        .def_property_readonly("format", &ResultFile::format)
        .def_property_readonly("missing", &ResultFile::missing)
        .def(
            "take_runs",
            [](ResultFile& self, const ResultFile& from, const std::vector<std::string>& names) {
                return copy_runs(from, self, names);
            },
            py::arg("source"), py::arg("names"), py::call_guard<Unlocked>())
        .def("flush", &ResultFile::flush)
        .def("copy_to", &ResultFile::copy_to, py::call_guard<Unlocked>())
        .def(
            "table",
            [](const ResultFile& self, const std::string& what, const std::vector<std::string>& runs,
               const std::string& label, const std::string& direction) {
                ResultTableRequest request;
                request.what = what;
                request.runs = runs;
                request.label = label;
                request.direction = direction;
                ResultTable table = result_table(self, request);
                return columns_of(std::move(table.rows), table.units);
            },
            py::arg("what"), py::arg("runs"), py::kw_only(), py::arg("label") = "", py::arg("direction") = "")
        .def(
            "findings",
            [](const ResultFile& self, const std::string& run, const std::string& what) {
                std::optional<Table> table;
                {
                    const Unlocked unlocked;
                    table = atlas_table(atlas_findings(stored_study(self), run, self), what);
                }
                return columns_of(*table);
            },
            py::arg("run"), py::arg("what"))
        .def(
            "query",
            [](const ResultFile& self, const std::string& sql, const std::vector<std::string>& runs) {
                ResultTable table = queried_table(self, sql, runs, {});
                return columns_of(std::move(table.rows), table.units);
            },
            py::arg("sql"), py::arg("runs"))
        .def(
            "orbits",
            [](const ResultFile& self, const std::string& run, bool special) {
                const auto record = self.find_run(run);
                py::list list;
                if (record)
                    for (const OrbitRecord& one : self.orbits(run, special))
                        list.append(facts_of_record(*record, one));
                return list;
            },
            py::arg("run"), py::kw_only(), py::arg("special"))
        .def(
            "orbit",
            [](const ResultFile& self, const std::string& run, const std::string& point) {
                const OrbitRecord record = orbit_named(self, run, point); // throws where there is no such run
                return facts_of_record(*self.find_run(run), record);
            },
            py::arg("run"), py::arg("point"))
        .def("motion", &motion_along, py::arg("run"), py::arg("point"), py::arg("samples"))
        .def("covariance", &covariance_of, py::arg("run"));
    // Connections to SQLite must not be closed by a forked process.
    module.def(
        "never_destroy", [](const py::object& object) { object.inc_ref(); }, py::arg("object"));
    module.def("result_table_names", &result_table_names);
}

} // namespace graze::python
