#pragma once

#include "graze/study/study.hpp"
#include "graze/study/workers.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

#include <memory>
#include <string>

namespace graze {

/// A study, its folder and its result file.
struct StudyRequest {
    Study study;
    std::string folder, file;

    /// Of a study that has its results in a folder.
    static StudyRequest in_folder(Study study, const std::string& folder);
};

/// Computes a study, lists what came out, and draws its pictures.
/// @param workers compute runs, too; null: there are none
/// @return the exit code
/// @throws InputError for names of runs that the study has not, and files that cannot be written
int compute_study(StudyRequest request, const RunArguments& arguments, const Console& console,
                  std::unique_ptr<Workers> workers);

} // namespace graze
