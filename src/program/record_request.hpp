#pragma once

#include "graze/picture/record_table.hpp"
#include "graze/record/processed_record.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// The processing of records that the command line asks for. Remarks on files are printed to the console.
/// @throws InputError
RecordProcessing record_processing(const RecordArguments& arguments, const Console& console);
/// The table that `graze record` is asked for. @throws InputError
RecordTableRequest record_table_request(const RecordArguments& arguments);

} // namespace graze
