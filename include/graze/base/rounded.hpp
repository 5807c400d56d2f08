#pragma once

namespace graze {

/// The number nearest to the decimal of so many significant digits that is nearest to `value`: 0.30000000000000004 is
/// 0.3 to 13 digits. What is not finite stays. @param digits 1 to 17
double rounded(double value, int digits);

} // namespace graze
