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

} // namespace graze
