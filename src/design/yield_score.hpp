#pragma once

namespace graze {

/// How surely a value is within limits, in standard deviations: the share of a normal distribution about it that lies
/// between them is that below the score, 1/2 (1 + erf(score/2^(1/2))). Unlike the share it tells far outside, too, into
/// which direction there is more. Limits may be infinite; the deviation is positive.
double yield_score(double least, double greatest, double value, double deviation);

/// The score of a share between 0 and 1.
double score_of_share(double share);

} // namespace graze
