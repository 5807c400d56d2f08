#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"
#include "program/program.hpp"

#include <string>
#include <vector>

namespace graze {

struct WrittenTables {
    std::vector<std::string> paths; ///< of what there is now
    bool complete = true;           ///< false: something could not be written
};

/// Writes all tables of a study into a folder, as CSV with all digits. Those that cannot be made are warned of: the
/// results are there. Nothing is written outside of the folder, and nothing anew that is as it would be.
WrittenTables write_study_tables(const Study& study, const ResultFile& file, const std::string& folder,
                                 const Console& console);

} // namespace graze
