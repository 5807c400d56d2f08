#pragma once

#include "graze/flow/variational_system.hpp"

#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace graze {

/// What variational systems of a model consist of, for each list of free parameters that was asked for.
struct System::Variations {
    std::mutex filling;
    std::map<std::vector<ParameterId>, std::shared_ptr<const VariationalSystem::Parts>> of;
};

} // namespace graze
