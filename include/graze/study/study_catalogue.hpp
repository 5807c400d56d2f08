#pragma once

#include "graze/study/study.hpp"

#include <string>
#include <vector>

namespace graze {

/// Names of the studies that come with graze (the files of studies/), in alphabetical order.
std::vector<std::string> shipped_studies();
/// The text of one of them. @throws InputError when there is none of that name (with the nearest)
std::string shipped_study_text(const std::string& name);
/// The study of this name or in this file, with values as in `parse_study`. @throws InputError when there is neither,
/// or something is wrong with it
Study load_study(const std::string& name_or_path, const ParameterValues& set = {});

} // namespace graze
