#pragma once

#include "graze/base/input_error.hpp"
#include "graze/study/study.hpp"

#include <fmt/format.h>

#include <string>

namespace graze {

/// Does some work on a record of a run: what goes wrong with it names the record, and where the run is.
template <class Work>
void at_record(const StudyRun& run, const std::string& name, const Work& work) {
    try {
        work();
    } catch (const InputError& error) {
        if (!error.place().file.empty())
            throw;
        throw InputError(run.place, fmt::format("{}: {}", name, error.problem()), error.remedy());
    }
}

} // namespace graze
