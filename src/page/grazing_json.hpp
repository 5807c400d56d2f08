#pragma once

#include "graze/results/result_file.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>

namespace graze {

/// What becomes of an orbit that touches: the verdict, its meaning in words, and facts (name, value, meaning), as
/// `graze grazing` lists them. @throws InputError for an unknown run or point, and for an orbit that does not touch
nlohmann::json grazing_json(const ResultFile& file, const std::string& run, std::size_t number);

} // namespace graze
