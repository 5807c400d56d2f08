#pragma once

#include <Eigen/Core>

namespace graze {

/// Directions in which points never differ: the normals of the smallest plane that holds them all, to within round-off.
/// A motion that lies on such a plane says nothing of what becomes of its neighbours beside it.
/// @param points in rows, in units in which each coordinate's extent is about one
/// @param away a direction that is left out, such as the one that leads off a section; zero: none
/// @return normals in columns, of length 1 and orthogonal to each other; none if there are too few points to tell
Eigen::MatrixXd normals_of_plane(const Eigen::MatrixXd& points, const Eigen::VectorXd& away);

} // namespace graze
