#include "graze/base/input_error.hpp"
#include "graze/grazing/map_motion.hpp"
#include "graze/picture/yield_picture.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/results/orbit_table.hpp"
#include "graze/results/point_list.hpp"
#include "graze/results/point_tolerances.hpp"
#include "graze/results/touch_facts.hpp"
#include "graze/study/stored_ladder.hpp"
#include "graze/study/yield_part.hpp"
#include "python/analysis_progress.hpp"
#include "python/figures.hpp"
#include "python/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <complex>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

namespace graze::python {

namespace {

// Grazing

py::array_t<double> square_of(const std::vector<double>& rows) {
    py::ssize_t size = 0;
    while (size * size < static_cast<py::ssize_t>(rows.size()))
        ++size;
    return array_of(rows, {size, size});
}

py::tuple columns_of_trial(const std::optional<Trial>& trial) {
    Table table{{"parameter", ""}, {"clearance", ""}, {"predicted", ""},
                {"largest", ""},   {"contacts", ""},  {"ended", ""}};
    if (trial)
        for (const TrialMotion& motion : trial->motions)
            table.add(motion.parameter, motion.clearance, motion.predicted, motion.largest, motion.contacts,
                      motion.ended);
    return columns_of(table);
}

py::dict grazing_of(const ResultFile& file, const std::string& point, const std::string& parameter, bool verify) {
    std::optional<TouchingOrbit> orbit;
    TouchReport report;
    attended([&](const std::function<bool()>& must_stop) {
        orbit = find_touching_orbit(file, point, parameter, of_point, of_parameter);
        TrialOptions options;
        options.interrupted = must_stop;
        report = with_place(of_parameter, [&] {
            return touch_report(System(orbit->stored.run.model), orbit->map, orbit->parameter, verify, options);
        });
    });
    const Model& model = orbit->stored.run.model;
    py::dict object;
    object["facts"] = columns_of(touch_facts(*orbit, report));
    object["reason"] = report.verdict.reason;
    object["trial_motions"] = columns_of_trial(report.trial);
    object["map"] = orbit->map;
    std::vector<std::string> active;
    for (const std::size_t state : orbit->map.active)
        active.push_back(model.states[state].name);
    object["active"] = active;
    object["states"] = names_of(model.states);
    object["event"] = model.events[orbit->map.touch.event].name;
    return object;
}

void bind_map(py::module_& module) {
    py::class_<CycleMap>(module, "CycleMap")
        .def_property_readonly("order", [](const CycleMap& map) { return std::string(name_of(map.contact.order)); })
        .def_property_readonly("reason",
                               [](const CycleMap& map) {
                                   return map.reason.empty() && !map.contact.exists() ? map.contact.reason : map.reason;
                               })
        .def_property_readonly("exists", &CycleMap::exists)
        .def_readonly("half", &CycleMap::half)
        .def_readonly("time", &CycleMap::time)
        .def_readonly("touches", &CycleMap::touches)
        .def_property_readonly("acceleration", [](const CycleMap& map) { return map.contact.acceleration; })
        .def_property_readonly("restitution", [](const CycleMap& map) { return map.contact.restitution; })
        .def_property_readonly("state", [](const CycleMap& map) { return array_of(map.contact.touch.state); })
        .def_property_readonly("direction", [](const CycleMap& map) { return array_of(map.contact.direction); })
        .def_property_readonly("scales", [](const CycleMap& map) { return array_of(map.scales); })
        .def_property_readonly("matrix", [](const CycleMap& map) { return square_of(map.matrix); })
        .def_property_readonly("impact", [](const CycleMap& map) { return array_of(map.impact); })
        .def_property_readonly("gradient", [](const CycleMap& map) { return array_of(map.gradient); })
        .def_property_readonly("multipliers", [](const CycleMap& map) { return array_of(map.multipliers); })
        .def_property_readonly("clearance_rate", [](const CycleMap& map) { return map.clearance_rate; })
        .def_property_readonly("steady", [](const CycleMap& map) { return array_of(map.steady); })
        .def("projections", [](const CycleMap& map, std::size_t count) { return array_of(map.projections(count)); })
        .def("image", [](const CycleMap& map, const std::vector<double>& state,
                         double clearance) { return array_of(map.image(state, clearance)); })
        .def(
            "motion",
            [](const CycleMap& map, double clearance, std::size_t transient, std::size_t cycles) {
                MapMotionOptions options;
                options.transient = transient;
                options.cycles = cycles;
                MapMotion motion;
                attended([&](const MustStop& must_stop) {
                    options.interrupted = must_stop;
                    motion = map_motion(map, clearance, options);
                });
                return py::make_tuple(motion.period, motion.contacts, motion.largest, motion.bounded);
            },
            py::arg("clearance"), py::arg("transient"), py::arg("cycles"));
}

// Tolerance

/// A point whose value is a function of other parameters, and the yield of devices that differ.
class HeldLocatedPoint {
public:
    HeldLocatedPoint(const ResultFile& file, const std::string& point, const std::string& parameter) {
        attended([&](const std::function<bool()>&) {
            found_.emplace(located_point(file, point, parameter, of_point, of_parameter));
            system_.emplace(found_->stored.run.model);
        });
    }

    void make_devices(const std::vector<std::string>& vary, const std::string& within, std::size_t devices,
                      std::uint64_t seed, int threads, const py::object& told,
                      const std::shared_ptr<PartExchange>& parts) {
        yield_.reset();
        settings_ = {};
        for (const std::string& item : vary)
            settings_.tolerances.push_back(
                with_place({"vary", 0, 0}, [&] { return read_tolerance(*found_, item, "vary"); }));
        if (!within.empty())
            read_interval(settings_, *found_, within, "within");
        settings_.devices = devices;
        settings_.seed = seed;
        settings_.jobs = threads;
        AnalysisProgress progress(title_of(found_->stored.record));
        progress.begin(devices);
        attended(
            [&](const std::function<bool()>& must_stop) {
                YieldSettings settings = settings_;
                settings.elsewhere = devices_by(parts);
                settings.interrupted = must_stop;
                settings.progress = [&](std::size_t made) { progress.note(made); };
                yield_ = with_place({"vary", 0, 0}, [&] {
                    return yield_of(*system_, found_->point, found_->located.control(), settings);
                });
            },
            progress.telling(told));
    }

    /// The point at other values of other parameters.
    py::dict solve(const std::vector<std::pair<std::string, double>>& given) {
        const LocatedValue& known = found_->located;
        std::vector<double> values = known.values();
        for (const auto& [name, value] : given) {
            const ParameterId parameter = found_->model.independent_parameter(name);
            const auto place = std::ranges::find(known.others(), parameter);
            if (place == known.others().end())
                throw InputError(fmt::format("'{}' is the parameter whose value follows from the others", name),
                                 "leave it out");
            values[static_cast<std::size_t>(place - known.others().begin())] = value;
        }
        LocatedSolution solution;
        attended([&](const std::function<bool()>&) {
            const std::lock_guard lock(mutex_);
            solution = found_->located(values);
        });
        py::dict object;
        object["found"] = solution.found;
        object["value"] = solution.found ? py::object(py::float_(solution.value)) : py::none();
        object["admissible"] = solution.admissible;
        object["problem"] = solution.problem;
        return object;
    }

    const LocatedPoint& found() const { return *found_; }
    const std::optional<Yield>& yield() const { return yield_; }
    /// @throws OrderError where there are none
    const Yield& made_devices() const {
        if (!yield_)
            throw OrderError("no devices have been made", "call make_devices first");
        return *yield_;
    }
    const YieldSettings& settings() const { return settings_; }
    py::object figure() const {
        return object_of(
            yield_picture(made_devices(), found_->name, found_->unit, settings_.least, settings_.greatest));
    }
    py::dict devices() const {
        std::vector<double> values, linear;
        std::vector<std::string> outcomes;
        for (const Device& device : made_devices().devices) {
            if (device.outcome == DeviceOutcome::not_made)
                continue;
            const bool is_found = device.outcome == DeviceOutcome::found;
            values.push_back(is_found ? device.value : std::numeric_limits<double>::quiet_NaN());
            linear.push_back(device.linear);
            outcomes.emplace_back(is_found                                        ? "found"
                                  : device.outcome == DeviceOutcome::inadmissible ? "inadmissible"
                                                                                  : "failed");
        }
        py::dict object;
        object["value"] = array_of(std::move(values));
        object["linear"] = array_of(std::move(linear));
        object["outcome"] = outcomes;
        return object;
    }

private:
    std::optional<LocatedPoint> found_;
    std::optional<System> system_;
    std::mutex mutex_; ///< a LocatedValue is used by one thread
    YieldSettings settings_;
    std::optional<Yield> yield_;
};

void bind_tolerance(py::module_& module) {
    using Held = HeldLocatedPoint;
    py::class_<Held>(module, "LocatedPoint")
        .def(py::init<const ResultFile&, const std::string&, const std::string&>(), py::arg("file"), py::arg("point"),
             py::arg("parameter"))
        .def_property_readonly("name", [](const Held& self) { return self.found().name; })
        .def_property_readonly("unit", [](const Held& self) { return self.found().unit; })
        .def_property_readonly("value", [](const Held& self) { return self.found().located.value(); })
        .def_property_readonly("has_yield", [](const Held& self) { return self.yield().has_value(); })
        .def_property_readonly("confidence", [](const Held& self) { return self.settings().confidence; })
        .def_property_readonly("problems",
                               [](const Held& self) {
                                   return self.yield() ? self.yield()->problems
                                                       : std::vector<std::pair<std::string, std::size_t>>();
                               })
        .def_property_readonly("interrupted",
                               [](const Held& self) { return self.yield() && self.yield()->interrupted; })
        .def("make_devices", &Held::make_devices, py::arg("vary"), py::kw_only(), py::arg("within"), py::arg("devices"),
             py::arg("seed"), py::arg("threads"), py::arg("told"), py::arg("parts") = std::shared_ptr<PartExchange>())
        .def("solve", &Held::solve)
        .def("derivatives",
             [](const Held& self) {
                 return columns_of(
                     derivative_table(self.found(), &self.settings(), self.yield() ? &*self.yield() : nullptr));
             })
        .def("statistics",
             [](const Held& self) { return columns_of(yield_table(self.made_devices(), self.found().name)); })
        .def("devices", &Held::devices)
        .def("figure", &Held::figure);
}

// Ladder

/// Grazings, each with one contact more, up to the onset of chatter.
class HeldLadder {
public:
    HeldLadder(std::string point, std::string parameter, std::size_t rungs)
        : point_(std::move(point)), parameter_(std::move(parameter)), rungs_(rungs) {}

    void climb(const ResultFile& file, const py::object& told) {
        AnalysisProgress progress(point_);
        progress.begin(rungs_);
        attended(
            [&](const std::function<bool()>& must_stop) {
                LadderRequest request;
                request.point = point_;
                request.point_place = of_point;
                request.parameter = parameter_;
                request.parameter_place = of_parameter;
                request.grazings = rungs_;
                request.interrupted = must_stop;
                request.progress = [&](std::size_t grazing) { progress.note(grazing); };
                found_.emplace(stored_ladder(file, request));
            },
            progress.telling(told));
    }
    bool has_grazings() const { return found_.has_value(); }
    py::dict object() const {
        if (!found_)
            throw OrderError("no grazings have been found", "call climb first");
        const ChatterLimit& limit = found_->limit;
        py::dict object;
        object["table"] = columns_of(ladder_table(*found_));
        object["parameter"] = found_->first.run.model.independent_parameters()[found_->parameter.place()];
        object["ends"] = found_->ladder.why();
        object["no_limit"] = limit.problem;
        const auto add = [&](const char* name, const std::optional<std::pair<double, double>>& found) {
            object[name] = found ? py::object(py::float_(found->first)) : py::none();
            object[(std::string(name) + "_error").c_str()] = found ? py::object(py::float_(found->second)) : py::none();
        };
        add("limit", limit.direct);
        add("extrapolated", limit.extrapolated);
        const bool known = limit.direct.has_value();
        object["restitution"] = known ? py::object(py::float_(limit.contacts.restitution)) : py::none();
        object["ratio"] = known ? py::object(py::float_(limit.contacts.ratio)) : py::none();
        return object;
    }

private:
    std::string point_, parameter_;
    std::size_t rungs_;
    std::optional<StoredLadder> found_;
};

// Orbits

/// The motion of a whole period, with further quantities, and why segments cannot be followed to their end.
py::tuple orbit_motion_of(const ResultFile& file, const std::string& point, const std::vector<std::string>& quantities,
                          std::size_t samples) {
    Table table;
    std::vector<std::string> problems;
    attended([&](const std::function<bool()>&) {
        const StoredOrbit stored = find_stored_orbit(file, point, of_point);
        const Orbit orbit = whole_orbit(System(stored.run.model), stored.record.point.solution.orbit);
        const Model model = model_at(stored.run.model, orbit);
        std::vector<NamedValue> values;
        for (const std::string& text : quantities)
            values.push_back(named_value(model, text, {"quantities " + text, 1, 1}));
        const std::vector<SegmentMotion> motion = orbit_motion(model, orbit, samples);
        table = orbit_table(model, motion, values);
        for (std::size_t s = 0; s < motion.size(); ++s)
            if (!motion[s].problem.empty())
                problems.push_back(
                    fmt::format("segment {} cannot be followed to its end: {}", s + 1, motion[s].problem));
    });
    return py::make_tuple(columns_of(table), problems);
}

py::dict certificate_of(const ResultFile& file, const std::string& point) {
    const StoredOrbit stored = find_stored_orbit(file, point, of_point);
    const Model& model = stored.run.model;
    const OrbitSolution& solution = stored.record.point.solution;
    py::dict object;
    object["signature"] = to_string(model, solution.orbit.signature);
    object["symmetry"] = solution.orbit.symmetry ? model.symmetries[*solution.orbit.symmetry].name : std::string();
    object["admissible"] = solution.certificate.admissible;
    object["reason"] = solution.certificate.reason;
    object["segments"] = columns_of(segment_table(model, solution));
    object["minima"] = columns_of(minimum_table(model, solution));
    object["end_values"] = columns_of(end_value_table(model, solution));
    return object;
}

py::tuple points_of(const ResultFile& file, const std::vector<std::string>& runs, const std::vector<std::string>& types,
                    bool all) {
    PointListRequest request{.runs = runs, .regular = all, .place = {"run", 0, 0}};
    for (const std::string& name : types) {
        const auto type = point_type(name);
        if (!type) {
            std::string known;
            for (const PointKind& kind : point_kinds())
                known += (known.empty() ? "" : ", ") + std::string(kind.short_name);
            throw InputError({"type", 0, 0}, fmt::format("there is no type of points '{}'", name),
                             "known are: " + known);
        }
        request.types.push_back(*type);
    }
    return columns_of(point_table(listed_points(file, request)));
}

} // namespace

void bind_analyses(py::module_& module) {
    bind_map(module);
    bind_tolerance(module);
    py::class_<HeldLadder>(module, "LadderOfGrazings")
        .def(py::init<std::string, std::string, std::size_t>(), py::arg("point"), py::arg("parameter"),
             py::arg("rungs"))
        .def("climb", &HeldLadder::climb, py::arg("file"), py::arg("told"))
        .def_property_readonly("has_grazings", &HeldLadder::has_grazings)
        .def("object", &HeldLadder::object);
    module.def("grazing", &grazing_of, py::arg("file"), py::arg("point"), py::kw_only(), py::arg("parameter"),
               py::arg("verify"));
    module.def("orbit_motion", &orbit_motion_of, py::arg("file"), py::arg("point"), py::arg("quantities"),
               py::arg("samples"));
    module.def("certificate", &certificate_of, py::arg("file"), py::arg("point"));
    module.def("listed_points", &points_of, py::arg("file"), py::kw_only(), py::arg("runs"), py::arg("types"),
               py::arg("all"));
}

} // namespace graze::python
