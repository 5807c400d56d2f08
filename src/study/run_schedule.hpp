#pragma once

#include "graze/study/study.hpp"

#include <cstddef>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace graze {

/// Names of the given runs, or of all runs if none are given, and of the runs that they need.
/// @throws InputError for the name of no run
std::set<std::string> wanted_runs(const Study& study, const std::vector<std::string>& only);

/// Conditions under which a run may begin.
struct ScheduledRun {
    std::vector<std::size_t> after{}; ///< earlier runs that have to end first
    std::size_t threads = 1;          ///< that it can use at most
};

/// Does runs side by side: each begins, in their order, as soon as the one that it waits for has ended and one of
/// `jobs` cores is free. It then gets as many threads as it can use, up to `jobs`, since a long run would otherwise be
/// left with few when the others have ended. With one job they are done one after the other, by the calling thread.
/// @param stopped asked before each run; runs that are not begun then are left out
/// @param work does a run with so many threads; called from several threads
/// @throws what `work` throws first, after all have ended; no run begins after that
void run_side_by_side(const std::vector<ScheduledRun>& runs, int jobs, const std::function<bool()>& stopped,
                      const std::function<void(std::size_t run, int threads)>& work);

} // namespace graze
