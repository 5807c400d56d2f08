#include "graze/study/yield_part.hpp"

#include "graze/base/require.hpp"
#include "graze/model/model_file.hpp"
#include "study/point_bytes.hpp"
#include "study/same_version.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace graze {

namespace {

/// The first bytes of solvers, of parts and of what comes back; they change with what follows.
const std::string solver_mark = "graze-solver-1\n", devices_mark = "graze-devices-1\n",
                  solved_mark = "graze-solved-1\n";

/// Of a special point what its condition depends on: see PointRule::condition.
template <class Bytes, class Point>
void describe_point(Bytes& bytes, Point& point) {
    bytes.choice(point.type, PointType::regular);
    bytes(point.segment, point.event, point.time, point.at_end);
    auto& orbit = point.solution.orbit;
    bytes.list(orbit.signature, [](Bytes& item, auto& segment) {
        item(segment.mode);
        item.choice(segment.end, SegmentEnd::saddle);
        item(segment.index);
    });
    bytes(orbit.parameters, orbit.starts, orbit.durations, orbit.symmetry);
}

template <class Bytes, class Options>
void describe_options(Bytes& bytes, Options& options) {
    bytes(options.orbit.tolerance, options.orbit.accuracy, options.orbit.iterations, options.orbit.error_estimate,
          options.halvings, options.map);
}

template <class Bytes, class Solved>
void describe_solved(Bytes& bytes, Solved& solved) {
    bytes.choice(solved.device.outcome, DeviceOutcome::failed);
    bytes(solved.device.value, solved.device.linear, solved.problem, solved.examined);
}

/// @throws InputError when a point does not fit its model; its orbit is checked by the solver
void require_fitting_point(const SpecialPoint& point, const Model& model) {
    require_index(point.segment, point.solution.orbit.segments(), "segment");
    require_index(point.event, std::max<std::size_t>(model.events.size(), 1), "event"); // 0 where there are none
    require_finite(point.time, "time of the point");
}

} // namespace

std::string bytes_of(const DeviceSolver& solver) {
    ByteWriter bytes(solver_mark);
    bytes(std::string(GRAZE_VERSION), write_equations(solver.system().model()), solver.control().place());
    std::vector<std::size_t> others;
    for (const ParameterId one : solver.others())
        others.push_back(one.place());
    bytes(others);
    describe_point(bytes, solver.point());
    describe_options(bytes, solver.options());
    bytes(solver.examination().request);
    return bytes.take();
}

bool is_device_solver(std::string_view bytes) {
    return bytes.starts_with(solver_mark);
}

DeviceSolver device_solver_of(std::string_view bytes, const MakeExamination& make_examination) {
    ByteReader reader(bytes, solver_mark);
    std::string version, model, request;
    reader(version);
    require_same_version(version, "part of a yield");
    std::size_t control = 0;
    std::vector<std::size_t> places;
    SpecialPoint point;
    LocatedValueOptions options;
    reader(model, control, places);
    describe_point(reader, point);
    describe_options(reader, options);
    reader(request);
    reader.require_end();
    const System system(parse_model(model, "model of a part of a yield"));
    require_fitting_point(point, system.model());
    const std::vector<ParameterId> others(places.begin(), places.end());
    DeviceExamination examination;
    if (!request.empty()) {
        if (!make_examination)
            throw InputError("devices are to be examined, and it is not known how", "let them be solved for elsewhere");
        examination = make_examination(system, point, ParameterId(control), request);
    }
    return {system, point, ParameterId(control), others, options, std::move(examination)};
}

std::string part_of(const AskedDevices& devices, ItemRange range) {
    require_room(devices.count, range.last, "devices of a part");
    require_room(range.last, range.first, "devices before a part");
    ByteWriter bytes(devices_mark);
    bytes(range.size());
    for (std::size_t device = range.first; device < range.last; ++device)
        bytes(devices.changes(device));
    return bytes.take();
}

std::string solved_part(const DeviceSolver& solver, std::string_view part, const std::function<bool()>& interrupted) {
    ByteReader reader(part, devices_mark);
    std::vector<std::vector<double>> devices;
    reader(devices);
    reader.require_end();
    for (const std::vector<double>& changes : devices)
        if (!changes.empty() && changes.size() != solver.others().size())
            ByteReader::fail();
    ByteWriter bytes(solved_mark);
    const auto must_stop = [&] { return interrupted && interrupted(); };
    for (const std::vector<double>& changes : devices) {
        const SolvedDevice solved = solver.solve(changes, interrupted);
        if (must_stop()) // maybe amid the examination
            return {};
        describe_solved(bytes, solved);
    }
    return bytes.take();
}

void read_devices(const AskedDevices& devices, ItemRange range, std::string_view bytes, const DeviceSink& sink) {
    require_room(devices.count, range.last, "devices of a part");
    require_room(range.last, range.first, "devices before a part");
    ByteReader reader(bytes, solved_mark);
    std::vector<SolvedDevice> all;
    while (!reader.is_at_end()) {
        if (all.size() == range.size())
            ByteReader::fail();
        describe_solved(reader, all.emplace_back());
    }
    if (all.size() != range.size())
        ByteReader::fail();
    for (std::size_t i = 0; i < all.size(); ++i)
        sink(range.first + i, all[i]);
}

DevicesElsewhere devices_by(const std::shared_ptr<PartExchange>& parts) {
    if (!parts)
        return {};
    return [parts](const AskedDevices& devices, const std::function<bool()>& interrupted, const DeviceSink& sink) {
        const auto take = [&](ItemRange range, const std::string& solved, bool) {
            read_devices(devices, range, solved, sink);
        };
        return parts->await({bytes_of(devices.solver),
                             {{0, devices.count}},
                             [&](ItemRange range) { return part_of(devices, range); },
                             take},
                            interrupted);
    };
}

} // namespace graze
