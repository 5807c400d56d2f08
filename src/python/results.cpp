#include "graze/results/orbit_motion.hpp"
#include "graze/results/result_table.hpp"
#include "graze/results/stored_orbit.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/results/table_text.hpp"
#include "python/tables.hpp"

#include <complex>

namespace graze::python {

namespace {

py::list units_of(const std::vector<ResultColumn>& columns) {
    py::list list;
    for (const ResultColumn& column : columns)
        list.append(py::make_tuple(column.name, column.unit));
    return list;
}

py::dict object_of(const RunRecord& run) {
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

py::dict object_of(const RunRecord& run, const OrbitRecord& record) {
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
    object["half_multipliers"] = array_of_multipliers(solution.half_multipliers);
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
        const py::gil_scoped_release unlocked;
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

py::list estimates_of(const ResultFile& file, const std::string& run) {
    py::list list;
    for (const EstimateRecord& one : file.estimates(run).numbers) {
        py::dict object;
        object["name"] = one.name;
        object["unit"] = one.unit;
        object["value"] = one.estimate.value;
        object["error"] = one.estimate.error;
        object["freedom"] = one.estimate.freedom;
        object["note"] = one.note;
        list.append(object);
    }
    return list;
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
                     list.append(object_of(run));
                 return list;
             })
        .def("remove_run", &ResultFile::remove_run)
        .def("flush", &ResultFile::flush)
        .def("copy_to", &ResultFile::copy_to, py::call_guard<py::gil_scoped_release>())
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
                        list.append(object_of(*record, one));
                return list;
            },
            py::arg("run"), py::kw_only(), py::arg("special"))
        .def(
            "orbit",
            [](const ResultFile& self, const std::string& run, const std::string& point) {
                return object_of(*self.find_run(run), orbit_named(self, run, point));
            },
            py::arg("run"), py::arg("point"))
        .def("motion", &motion_along, py::arg("run"), py::arg("point"), py::arg("samples"))
        .def("estimates", &estimates_of, py::arg("run"))
        .def("covariance",
             [](const ResultFile& self, const std::string& run) { return array_of(self.estimates(run).covariance); });
    module.def("result_table_names", &result_table_names);
}

} // namespace graze::python
