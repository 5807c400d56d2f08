#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Everything that the numbers of a run depend on, besides its model and the run that it starts from, as a JSON object.
std::string settings_of(const StudyRun& run);
/// All that a picture asks for, as a JSON object.
std::string settings_of(const StudyPicture& picture);
/// Equal for equal texts everywhere, and different for others with near certainty: a short text in place of a long one.
std::string fingerprint_of(std::string_view text);
/// A run as it was asked for, from what a result file has of it: `run_study` goes on with it, or does it again.
/// @throws InputError when the settings cannot be read, or are of another version with more of them
StudyRun stored_run(const RunRecord& record);

/// Keeps in a result file what it needs besides the runs that are begun: the study's name, words and pictures, and all
/// of its runs as they were asked for.
void store_study(const Study& study, ResultFile& file);
/// The values with which the study of a result file was read instead of its own; none if it holds no study.
/// @throws InputError when they cannot be read
std::optional<ParameterValues> stored_set(const ResultFile& file);
/// The study of a result file, made of nothing else.
/// @throws InputError when something cannot be read
Study stored_study(const ResultFile& file);

} // namespace graze
