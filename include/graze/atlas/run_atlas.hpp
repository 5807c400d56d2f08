#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/elsewhere.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/study.hpp"

#include <functional>
#include <string>
#include <vector>

namespace graze {

/// Carries out runs of a study, as run_study does.
using StudyRunner =
    std::function<std::vector<RunReport>(const Study& study, ResultFile& file, const RunnerOptions& options)>;

/// Carries out a study, and explores where its runs of kind atlas lead. From the attractors that such a run has
/// sampled, and from others that are reached from random states, it follows branches of orbits, and the branches that
/// leave their flips, branch points and grazings; in two parameters also the curves of all points found, and those that
/// begin at their points of codimension two. What is found twice is noticed, and stable orbits that no motion has
/// settled on are confirmed by one. All this is done by runs that the study itself could contain. They are named after
/// the atlas
/// ("map.branch3"), added to the study, and stored like others: an exploration that was interrupted goes on, and its
/// results do not depend on the number of threads.
/// @param study to which runs are added
/// @param runner computes runs, perhaps elsewhere
/// @return reports of all runs, in the order of the study
/// @throws InputError as run_study
std::vector<RunReport> run_with_atlases(Study& study, ResultFile& file, const RunnerOptions& options,
                                        const StudyRunner& runner);

/// Adds to a study the runs that its atlases have made so far, as results have them, and those that come next, once
/// these have all been computed. Processes that compute parts of a study (run_part) explore an atlas by this: each of
/// them, given the same results, adds the same runs.
/// @return names of the runs that come next; none where nothing is left to do, or runs before them are missing
/// @throws InputError when results cannot be read
std::vector<std::string> add_atlas_runs(Study& study, const ResultFile& results);

/// Removes from results what atlases have explored whose samples are no longer those that are asked for.
void forget_outdated_atlases(const Study& study, ResultFile& results);

/// Whether a study has runs of kind atlas.
bool has_atlas(const Study& study);

} // namespace graze
