#pragma once

#include "graze/study/fit_records.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

#include <vector>

namespace graze {

/// The fit that a command line describes.
struct FitRequest {
    StudyRun run; ///< of kind identify; its model has the values of --set and --start
    std::vector<KeptRecord> records;
};

/// Makes the request from the options and reads the records. @throws InputError
FitRequest fit_request(const IdentifyArguments& arguments, const Console& console);

} // namespace graze
