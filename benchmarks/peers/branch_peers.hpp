#pragma once

namespace peers {

/// Prints tables of branches followed by graze and by AUTO-07p: what a point takes, what was located, and in how many
/// digits both agree.
void compare_branches(bool quick);

} // namespace peers
