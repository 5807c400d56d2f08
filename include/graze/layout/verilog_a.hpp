#pragma once

#include "graze/model/model.hpp"

#include <string>

namespace graze {

/// Returns a device as a Verilog-A module for circuit simulators: the mass with spring and damper, the attraction of
/// the electrodes with the corresponding charge, and contacts. Parameters have the model's names, in SI units.
///
/// Between contacts the equations are the model's. A rigid stop with restitution e becomes a spring and a damper in
/// parallel: on a stop the mass alone oscillates at `hardness` times its natural frequency, with the damping ratio
/// -ln(e)/(pi^2 + ln(e)^2)^(1/2), for which half a period leaves the share e of the speed. No singularity occurs when
/// the electrodes meet: they rest on one another when the remaining gap is `closed`.
/// @param model with the parameters m, f0, zeta, area, d, stop and e, such as mems-switch-device
/// @param name of the device; the module's name is made of its characters that Verilog-A allows, and "_va"
/// @param generator name of the program, such as "graze 1.0"
/// @throws InputError when the model lacks one, its unit has another dimension, or its value is out of range
std::string verilog_a_text(const Model& model, const std::string& name, const std::string& generator);

/// Whether a model has these parameters.
bool has_verilog_a(const Model& model);

} // namespace graze
