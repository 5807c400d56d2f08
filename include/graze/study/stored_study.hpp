#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Returns all settings that the results of a run depend on, except its model and the runs that it needs, and those of
/// the exploration of an atlas, as a JSON object.
std::string settings_of(const StudyRun& run);
/// Returns all settings of a picture as a JSON object.
std::string settings_of(const StudyPicture& picture);
/// Returns a hash of a text, of 32 hexadecimal digits, which is the same on all machines.
std::string fingerprint_of(std::string_view text);
/// Returns a run as it was asked for, from its record in a result file: `run_study` can continue or repeat it.
/// @throws InputError when the settings cannot be read, or are of another version with more of them
StudyRun stored_run(const RunRecord& record);

/// Stores a study in a result file: its name, texts, pictures and tables, and all runs as they were asked for.
void store_study(const Study& study, ResultFile& file);
/// Returns the values (Study::set) with which the study of a result file was read; none if the file has no study.
/// @throws InputError when they cannot be read
std::optional<ParameterValues> stored_set(const ResultFile& file);
/// Returns the values (Study::set) with which a result file was made if they are others than those of a study: one file
/// holds results of one set only.
std::optional<ParameterValues> other_set(const Study& study, const ResultFile& file);
/// Refuses results of other values.
/// @param words that say values, which are not empty, to whoever asks for the study
/// @throws InputError with this remedy
void require_same_values(const Study& study, const ResultFile& file,
                         const std::function<std::string(const ParameterValues& set)>& words,
                         const std::string& remedy);
/// Returns the study of a result file, which needs no other file.
/// @throws InputError when something cannot be read
Study stored_study(const ResultFile& file);
/// The same with only the runs that were asked for when the results were last computed, and in their order.
Study asked_study(const ResultFile& file);

} // namespace graze
