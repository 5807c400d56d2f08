#pragma once

#include "graze/identify/identification.hpp"
#include "graze/study/study.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// The run of kind identify that the command line asks for. Its numbers are in the units of the records: it has no
/// model.
/// @throws InputError
StudyRun identify_request(const IdentifyArguments& arguments);
/// The records that are named, processed as the command line asks.
EachRecord identify_files(const IdentifyArguments& arguments, const Console& console);

} // namespace graze
