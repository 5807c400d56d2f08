#pragma once

#include "graze/study/study.hpp"

#include <nlohmann/json.hpp>

namespace graze {

/// The pictures that a study describes: name, kind (empty: by the kind of the run), title and runs.
nlohmann::json pictures_json(const Study& study);

} // namespace graze
