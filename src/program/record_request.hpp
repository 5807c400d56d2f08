#pragma once

#include "graze/picture/record_table.hpp"
#include "graze/record/processed_record.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// What the command line asks to be done to records before a table is made of them. Remarks on files go to the console.
/// @throws InputError
RecordProcessing record_processing(const RecordArguments& arguments, const Console& console);
/// The table that `graze record` is asked for. @throws InputError
RecordTableRequest record_table_request(const RecordArguments& arguments);

} // namespace graze
