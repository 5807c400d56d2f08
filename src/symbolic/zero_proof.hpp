#pragma once

#include "graze/symbolic/zero_search.hpp"
#include "symbolic/square_system.hpp"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace graze {

/// Returns the zero to which Newton's method converges, with as many digits as round-off allows. @param scales of the
/// unknowns; @return none when it does not converge in `within`
std::optional<std::vector<double>> newton(SquareSystem& system, std::vector<double> start, const IntervalBox& within,
                                          const Eigen::VectorXd& scales);

/// Proves that there is one zero near an approximate one, by Krawczyk's operator: if it maps a box into its interior,
/// the box has exactly one zero. @param radius of the first box that is tried, in units of the scales; smaller ones
/// follow, or larger ones up to 1
/// @return none if that fails, as where the Jacobian is nearly singular
std::optional<VerifiedZero> prove_zero(SquareSystem& system, std::span<const double> zero, double radius,
                                       const Eigen::VectorXd& scales);

} // namespace graze
