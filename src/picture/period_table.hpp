#pragma once

#include "graze/picture/record_table.hpp"

#include <memory>

namespace graze {

/// Tables whose rows are periods of a reference: periods, sections and extremes.
std::unique_ptr<RecordTable> period_table(const RecordTableRequest& request, bool several);

/// @throws InputError where the table has too many rows to be kept
void require_few_rows(const Table& table);

} // namespace graze
