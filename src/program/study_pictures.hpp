#pragma once

#include "graze/picture/result_picture.hpp"
#include "graze/results/result_file.hpp"
#include "program/program.hpp"

#include <string>
#include <vector>

namespace graze {

struct DrawnPictures {
    std::vector<std::string> paths; ///< of what there is now
    std::size_t kept = 0;           ///< pictures that were there already
    bool complete = true;           ///< false: something could not be drawn
    bool interrupted = false;       ///< before all were drawn
};

/// Draws all pictures of a study into a folder, or one for each run if it asks for nothing; tables beside them.
/// Pictures that cannot be drawn are warned of: the results are there. Nothing is written outside of the folder. The
/// result file remembers what was drawn: a picture of the same, whose files are as they were written, is kept.
DrawnPictures draw_study_pictures(const Study& study, ResultFile& file, const std::string& folder,
                                  const Console& console);

} // namespace graze
