#pragma once

#include "graze/study/fit_records.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

#include <vector>

namespace graze {

/// A fit as the command line asks for it.
struct FitRequest {
    StudyRun run; ///< of kind identify, whose model has the values that are set
    std::vector<KeptRecord> records;
};

/// Reads the model and the records. @throws InputError
FitRequest fit_request(const IdentifyArguments& arguments, const Console& console);

} // namespace graze
