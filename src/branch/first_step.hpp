#pragma once

#include "branch/branch_state.hpp"

#include <optional>
#include <string>
#include <utility>

namespace graze {

/// Returns why a curve ends after its first step, because it leads to a side without orbits of its kind: inadmissible
/// ones, two real multipliers on a curve of torus points, or a contact of negative speed. Empty if it does not.
std::optional<std::pair<BranchOutcome, std::string>>
wrong_side(const BranchSettings& settings, const DescribedPoint& start, const DescribedPoint& here);

} // namespace graze
