#pragma once

namespace peers {

/// Prints tables of motions with derivatives by graze and by CVODES: times at equal error, and how far apart contacts
/// are.
void compare_derivatives(bool quick);

} // namespace peers
