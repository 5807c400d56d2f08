#pragma once

#include <Eigen/Core>

namespace graze {

/// Returns the normals of the smallest plane that contains all points, to within round-off: the directions in which the
/// points do not differ. A motion on such a plane gives no information on its neighbours beside it.
/// @param points in rows, in units in which the extent of each coordinate is about one
/// @param away a direction that is excluded, such as the one that leads off a section; zero: none
/// @return normals in columns, orthonormal; none if there are too few points
Eigen::MatrixXd normals_of_plane(const Eigen::MatrixXd& points, const Eigen::VectorXd& away);

} // namespace graze
