#pragma once

#include "graze/picture/result_picture.hpp"
#include "graze/results/result_file.hpp"
#include "program/program.hpp"

#include <string>
#include <vector>

namespace graze {

/// Result of draw_study_pictures.
struct DrawnPictures {
    std::vector<std::string> paths; ///< all files of pictures that exist now
    std::size_t kept = 0;           ///< pictures that existed already and were not drawn again
    bool complete = true;           ///< false: something could not be drawn
    bool interrupted = false;       ///< before all were drawn
};

/// Draws all pictures of a study into a folder, with their tables; one for each run if the study has no pictures. A
/// picture that cannot be drawn gives a warning. No file is written outside the folder. The result file remembers what
/// was drawn: a picture of unchanged results whose files have not changed is kept.
DrawnPictures draw_study_pictures(const Study& study, ResultFile& file, const std::string& folder,
                                  const Console& console);

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
