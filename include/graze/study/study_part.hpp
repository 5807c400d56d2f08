#pragma once

#include "graze/study/runner.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace graze {

// A study can be computed in parts, by processes that need not know of each other, each into a result file of its own.
// It consists of tasks: some neighbouring chains of a run of motions, or a whole run of another kind. Tasks are
// numbered in the order of the study, and dealt out to the parts in turn: neighbours, which often take equally long, go
// to different parts. The numbers of a task do not depend on the part that it belongs to.

/// One of several parts.
struct StudyPart {
    std::size_t number = 1; ///< from 1 to `count`
    std::size_t count = 1;

    bool operator==(const StudyPart&) const = default;
};

/// "3/64"
std::string text_of(const StudyPart& part);
/// @throws InputError unless the text is of that form
StudyPart study_part(const std::string& text);

/// Name of the file of a part, in the folder of all parts: "3-of-64.sqlite".
std::string file_of_part(const StudyPart& part);

/// The part that a result file holds; none: it is the file of a whole study.
std::optional<StudyPart> part_in(const ResultFile& file);
/// Whether all that can be computed of that part has been.
bool has_ended(const ResultFile& file);

/// Runs that no part can begin: they need all points of runs of motions, which several parts compute. Once these have
/// been merged, parts that begin with the merged results compute them.
/// @param results that are there already; null: none
std::vector<std::string> waiting_runs(const Study& study, const ResultFile* results);

/// What has come of a part.
struct PartReports {
    std::vector<RunReport> runs{};      ///< that it has something of; one is `partial` if it is shared with other parts
    std::vector<std::string> waiting{}; ///< see waiting_runs
};

/// Carries out a part of a study, and goes on where it was interrupted. Runs that `results` have are left out, and
/// those that other runs need are taken from there. A run that is no task of this part, but that one of its tasks
/// needs, is computed by this part as well.
/// @param results that are there already; null: none
/// @param file of the part
/// @throws InputError as run_study
PartReports run_part(const Study& study, const StudyPart& part, const ResultFile* results, ResultFile& file,
                     const RunnerOptions& options);

} // namespace graze
