#pragma once

#include "study/study_reader.hpp"

namespace graze {

/// Reads what says how a picture looks, rather than what it shows. @return whether the key is one of these
bool read_style(const StudyReader& reader, const TomlEntry& entry, StudyPicture& picture);

} // namespace graze
