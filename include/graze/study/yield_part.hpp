#pragma once

#include "graze/base/item_range.hpp"
#include "graze/branch/device_solver.hpp"
#include "graze/study/part_exchange.hpp"

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace graze {

// The devices of a yield can be solved for by any process, in parts: YieldSettings::elsewhere gives somebody else the
// solver once, and then some devices at a time, all as bytes; what comes back are bytes again.

/// All that another process needs in order to make the same solver.
std::string bytes_of(const DeviceSolver& solver);
/// Whether these are bytes of a solver, by how they begin.
bool is_device_solver(std::string_view bytes);

/// Makes the examination of a request, as the process that wrote it has done.
using MakeExamination = std::function<DeviceExamination(const System& system, const SpecialPoint& point,
                                                        ParameterId control, const std::string& request)>;
/// The solver of bytes that `bytes_of` wrote, by the same version of graze.
/// @param examination needed for solvers that have one
/// @throws InputError for another version, and for bytes of no solver
DeviceSolver device_solver_of(std::string_view bytes, const MakeExamination& examination = {});

/// Some devices, for somebody else to solve for.
std::string part_of(const AskedDevices& devices, ItemRange range);
/// Solves for the devices of a part with one thread. @return for read_devices; empty: it was interrupted
/// @throws InputError when the bytes are no part of devices of this solver
std::string solved_part(const DeviceSolver& solver, std::string_view part, const std::function<bool()>& interrupted);
/// Gives the devices of a part, all bits of them, to `sink`.
/// @throws InputError, before any device is given, when the bytes are none of `solved_part` of this part
void read_devices(const AskedDevices& devices, ItemRange range, std::string_view bytes, const DeviceSink& sink);

/// For settings of yields: has devices solved for by whoever empties the exchange; none without an exchange, for
/// threads of this process to do it.
DevicesElsewhere devices_by(const std::shared_ptr<PartExchange>& parts);

} // namespace graze
