#pragma once

#include "study/identify_run.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace graze {

/// A fit of a run's model to records, all of them at once. Of each record those parameters are known that it has as
/// coordinates.
/// @return nothing when it was interrupted. @throws InputError for tasks without meaning
std::optional<FoundByRun> identify_fit_of(const StudyRun& run, const std::vector<KeptRecord>& records,
                                          const std::function<bool()>& interrupted);

} // namespace graze
