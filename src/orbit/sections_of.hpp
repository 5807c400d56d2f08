#pragma once

#include "graze/orbit/signature.hpp"
#include "graze/trajectory/simulation.hpp"

#include <vector>

namespace graze {

/// Returns the sections at which segments of a signature end, each once, in the order of the model.
std::vector<std::size_t> sections_of(const Model& model, const Signature& signature);
/// Returns probes of these sections, in the same order.
std::vector<Probe> probes_of(const Model& model, const Signature& signature);

} // namespace graze
