#pragma once

namespace peers {

/// Prints tables of branches followed by graze and by AUTO-07p: time per point, located points, and the number of
/// digits in which both agree.
void compare_branches(bool quick);

} // namespace peers
