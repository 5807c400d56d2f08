#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Reads a study that goes on from another one: its runs may start from the runs of that one, and use what they have
/// found.
/// @param study stays as it is @param text, file, models as in parse_study
/// @return the runs of both, in an order in which each follows those that it needs, with the name of the text
/// @throws InputErrors, InputError as parse_study, and for a name that a run of the study has
Study parse_further_runs(std::string_view text, const std::string& file, const Study& study,
                         const NamedModels& models = {});

/// Copies runs, and those that they need, with all their results into another result file. A run that is there already
/// is not copied; one whose name is that of another run there gets a free name.
/// @return the names there, by the names in the first file
/// @throws InputError when the first file has no such run, and when the other one cannot be written
std::map<std::string, std::string> copy_runs(const ResultFile& from, ResultFile& to,
                                             const std::vector<std::string>& names);

} // namespace graze
