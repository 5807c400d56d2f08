#pragma once

#include "graze/identify/fit.hpp"
#include "graze/model/model.hpp"
#include "graze/record/samples.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

#include <string>
#include <vector>

namespace graze {

/// A fit as the command line asks for it.
struct FitRequest {
    Model model; ///< with the values that are set
    FitTask task;
    FitSettings settings;
    std::vector<Channel> channels; ///< of each output
    std::vector<std::string> files;
    Channel time; ///< of the first record
};

/// Reads the records. @throws InputError
FitRequest fit_request(const IdentifyArguments& arguments, const Console& console);

} // namespace graze
