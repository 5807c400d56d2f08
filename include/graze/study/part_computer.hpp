#pragma once

#include "graze/study/messages.hpp"

#include <cstddef>

namespace graze {

/// What the processes other than process 0 do until it tells them to end: they compute what a PartDealer there deals
/// out to them.
/// @param threads each computes one part at a time
void compute_parts(Messages& messages, std::size_t threads);

} // namespace graze
