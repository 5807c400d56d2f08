#pragma once

namespace graze {

/// Returns `value` rounded to `digits` significant decimal digits: 0.30000000000000004 becomes 0.3 with 13 digits. NaN
/// and infinities are returned unchanged. @param digits 1 to 17
double rounded(double value, int digits);

} // namespace graze
