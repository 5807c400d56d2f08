#pragma once

#include "graze/study/study.hpp"

#include <string>

namespace graze {

/// Refuses an addition to the text of a study that does more than to add runs and pictures, for example by keys that
/// would belong to the last table before it. @throws InputError with a place in the addition
void require_only_new(const std::string& addition, const Study& study);

/// The path of a new study: NAME.toml in the folder, or NAME-2.toml and so on where files are.
std::string free_study_file(const std::string& folder, const std::string& name);

/// Whether a study in the folder is one of this model, as far as it says for all runs.
bool is_study_of(const std::string& text, const std::string& model, const std::string& folder);

/// Whether the text has runs, or mistakes, which its reader will tell.
bool may_have_runs(const std::string& text, const std::string& file);

} // namespace graze
