#pragma once

#include "graze/study/merged_parts.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

#include <string>
#include <vector>

namespace graze {

/// Lets this process open as many files as the system allows: usually that is more than the thousand that it begins
/// with.
void allow_many_files();
/// Puts parts together, and shows how that goes on. @param study to which the runs of its
/// atlases are added; @param only runs that are wanted; empty: all
/// @throws InputError, also if the parts were computed with other values of --set than the study has
MergedParts merge_files(Study& study, const std::vector<ResultFile>& parts, const std::vector<std::string>& only,
                        ResultFile& file, const StudyArguments& arguments, const Console& console);
/// Lists the runs, draws the pictures if nothing is missing, and otherwise says what is. @return the exit code
int finish_merge(const Study& study, const MergedParts& merged, ResultFile& file, const std::string& folder,
                 const StudyArguments& arguments, const Console& console);

} // namespace graze
