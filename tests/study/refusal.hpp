#pragma once

#include "graze/base/input_error.hpp"
#include "graze/study/runner.hpp"

#include <string>

namespace graze {

/// What refuses a study, or fails the first of its runs that does; empty: nothing.
/// @param run what does the study and gives its reports
template <class Run>
std::string refusal_of(const Run& run) {
    try {
        for (const RunReport& report : run())
            if (!report.problem.empty())
                return report.problem + "; " + report.remedy;
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

} // namespace graze
