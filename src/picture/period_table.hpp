#pragma once

#include "graze/picture/record_table.hpp"

#include <memory>

namespace graze {

/// Tables whose rows are periods of a reference: periods, sections and extremes.
std::unique_ptr<RecordTable> period_table(const RecordTableRequest& request, bool several);

/// @param asked_as what stands before names of settings in messages
/// @throws InputError where the table has too many rows to be kept
void require_few_rows(const Table& table, const std::string& asked_as);

} // namespace graze
