#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"
#include "program/program.hpp"

#include <string>
#include <vector>

namespace graze {

/// Result of write_study_tables.
struct WrittenTables {
    std::vector<std::string> paths; ///< all files of tables that exist now
    bool complete = true;           ///< false: something could not be written
};

/// Writes all tables of a study into a folder, as CSV with all digits. A table that cannot be made gives a warning. No
/// file is written outside the folder, and files with the same contents are not written again.
WrittenTables write_study_tables(const Study& study, const ResultFile& file, const std::string& folder,
                                 const Console& console);

} // namespace graze
