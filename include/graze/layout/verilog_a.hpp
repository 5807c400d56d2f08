#pragma once

#include "graze/model/model.hpp"

#include <string>

namespace graze {

/// A device as a module of Verilog-A, for circuit simulators: the mass on its spring and damper, the attraction of the
/// electrodes with the charge that belongs to it, and contacts. Parameters have the model's names, in units of the SI.
///
/// Between contacts the equations are the model's. A rigid stop that returns a share e of the speed becomes a spring
/// and a damper in parallel: on a stop the mass alone would swing with `hardness` times its natural frequency, and the
/// ratio of damping -ln(e)/(pi^2 + ln(e)^2)^(1/2) is that of which half a swing leaves e of the speed. Nothing is
/// singular where the electrodes meet: they rest on one another when the gap that is left is `closed`.
/// @param model with the parameters m, f0, zeta, area, d, stop and e, as mems-switch-device
/// @param name of the device; the module's is that with what Verilog-A allows in names, and "_va"
/// @param generator who says so, as "graze 1.0"
/// @throws InputError when the model lacks one, has it in a unit of another kind, or with a value that is none
std::string verilog_a_text(const Model& model, const std::string& name, const std::string& generator);

/// Whether the model has these parameters.
bool has_verilog_a(const Model& model);

} // namespace graze
