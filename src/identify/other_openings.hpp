#pragma once

#include "identify/fit_rows.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace graze {

/// Other states in which a record might begin than the one at which small steps end.
///
/// Phases that nothing has read: all around their period, unless readings of the first piece hardly depend on the
/// phase, which then had better stay as it was guessed. And the other side of a contact that is close to the first
/// reading: where a velocity, say, is not read, a motion that leaves a stop and one that is about to hit it begin
/// alike, and no small step leads from one to the other.
std::vector<Eigen::VectorXd> other_openings(FitRows& rows, const FitPoint& point, std::size_t piece);

} // namespace graze
