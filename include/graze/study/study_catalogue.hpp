#pragma once

#include "graze/study/study.hpp"

#include <string>
#include <vector>

namespace graze {

/// Names of the studies that come with graze, in alphabetical order.
std::vector<std::string> shipped_studies();
/// The text of a study that comes with graze. @throws InputError when there is none of that name, with the nearest one
std::string shipped_study_text(const std::string& name);
/// Reads the study that comes with graze under this name, or the one in this file. @param set as in parse_study
/// @throws InputError when there is neither, and as parse_study does
Study load_study(const std::string& name_or_path, const ParameterValues& set = {});

} // namespace graze
