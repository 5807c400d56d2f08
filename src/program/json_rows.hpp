#pragma once

#include "program/table.hpp"

#include <vector>

namespace graze {

/// The rows of a table as objects with the columns' names; a number that is missing is left out.
std::vector<JsonObject> json_rows(const Table& table);

} // namespace graze
