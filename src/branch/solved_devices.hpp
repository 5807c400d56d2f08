#pragma once

#include "graze/branch/yield.hpp"

#include <cstddef>
#include <functional>

namespace graze {

/// Told of what has been solved for each device that was found: by any thread, by several at once.
using SolvedDevice = std::function<void(std::size_t device, const LocatedSolution& solution)>;

/// The yield of given devices, each of which is looked at more closely by the thread that has it.
Yield yield_of(const System& system, const SpecialPoint& point, ParameterId control, const MadeDevices& devices,
               const YieldSettings& settings, SolvedDevice solved);

} // namespace graze
