#pragma once

#include "graze/study/messages.hpp"
#include "graze/study/run_part.hpp"
#include "graze/study/yield_part.hpp"

#include <cstddef>
#include <functional>
#include <string>

namespace graze {

/// Computes a part of some work, in any process and with one thread.
/// @param part what PartExchange gives for it
/// @param sink receives pieces of the result while it goes on, where the work has such; without one there is one piece
/// @return the last piece; empty: it was interrupted
using PartComputation = std::function<std::string(const std::string& part, const std::function<bool()>& interrupted,
                                                  const PieceSink& sink)>;

/// How parts of work are computed.
/// @param text of the work, see PartedWork
/// @param examination needed for yields whose devices are examined
/// @throws InputError for another version of graze, and for a text of no work
PartComputation computation_of(const std::string& text, const MakeExamination& examination);

/// What the processes other than process 0 do until it tells them to end: they compute what a PartDealer there deals
/// out to them.
/// @param threads each computes one part at a time
/// @param examination see computation_of
void compute_parts(Messages& messages, std::size_t threads, const MakeExamination& examination = {});

} // namespace graze
