#pragma once

#include "graze/study/runner.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

#include <optional>
#include <string>
#include <vector>

namespace graze {

// What commands that compute a study, or a part of it, have in common.

inline constexpr const char* folder_of_parts = "parts"; ///< in the folder of a study's results

/// Values as "k=50,m=2".
std::string text_of_values(const ParameterValues& set);
/// @throws InputError if the result file was made with other values of --set
void require_same_values(const Study& study, const ResultFile& file);
/// The results of a study, for reading; none if there is no such file. @throws InputError as require_same_values
std::optional<ResultFile> earlier_results(const Study& study, const std::string& path);

bool is_interrupted(const std::vector<RunReport>& reports);
/// Says that the same command goes on from there. @return the exit code
int told_interruption(const Console& console);
/// Leaves out the runs that atlases have made: what the atlases tell sums these up.
std::vector<RunReport> asked_for(const Study& study, const std::vector<RunReport>& reports);
/// Prints failed runs, with their remedies. @return true if there are any
bool tell_failures(const std::vector<RunReport>& reports, const Console& console);
/// Lists the runs with their results, unless nothing is to be listed.
void list_runs(const std::vector<RunReport>& reports, const ResultFile& file, const StudyArguments& arguments,
               const Console& console);
/// Lists the runs and failures, tells what atlases have found, and draws the pictures. @return the exit code
int finish_study(const Study& study, const std::vector<RunReport>& reports, ResultFile& file, const std::string& folder,
                 const StudyArguments& arguments, const Console& console);

} // namespace graze
