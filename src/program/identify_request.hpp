#pragma once

#include "graze/identify/identification.hpp"
#include "graze/study/fit_records.hpp"
#include "graze/study/study.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

#include <vector>

namespace graze {

/// The run of kind identify that a command line describes. It has no model; its numbers are in the units of the
/// records.
/// @throws InputError
StudyRun identify_request(const IdentifyArguments& arguments);
/// Returns a function that opens each named record in turn, processed as the options say, and hands it on.
EachRecord identify_files(const IdentifyArguments& arguments, const Console& console);

/// The fit that a command line describes.
struct FitRequest {
    StudyRun run; ///< of kind identify; its model has the values of --set and --start
    std::vector<KeptRecord> records;
};

/// Makes the request from the options and reads the records. @throws InputError
FitRequest fit_request(const IdentifyArguments& arguments, const Console& console);

} // namespace graze
