#pragma once

#include "graze/branch/device_solver.hpp"

#include <string>
#include <vector>

namespace graze {

struct ExaminedYield {
    Yield yield;
    std::vector<std::string> examined; ///< what the examination has found of each device; empty where it found nothing
};

/// The yield of given devices, each of which is examined when it has been found.
ExaminedYield examined_yield_of(const System& system, const SpecialPoint& point, ParameterId control,
                                const MadeDevices& devices, const YieldSettings& settings,
                                DeviceExamination examination);

} // namespace graze
