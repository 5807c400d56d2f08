#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"
#include "program/figure.hpp"
#include "program/program.hpp"
#include "program/table.hpp"

#include <string>
#include <vector>

namespace graze {

/// A picture made from results, with the table of what was computed for it, if anything.
struct ResultPicture {
    Figure figure;
    Table table;
};

/// @throws InputError when the picture asks for something that the results do not have
ResultPicture make_picture(const StudyPicture& picture, const ResultFile& file);
/// What a run is shown as when nothing is said: by its kind.
StudyPicture default_picture(const RunRecord& run);

struct DrawnPictures {
    std::vector<std::string> paths; ///< of what was written
    bool complete = true;           ///< false: something could not be drawn
};

/// Draws all pictures of a study into a folder, or one for each run if it has none; tables beside them. Pictures that
/// cannot be drawn are warned of: the results are there. Nothing is written outside of the folder.
DrawnPictures draw_study_pictures(const Study& study, const ResultFile& file, const std::string& folder,
                                  const Console& console);

} // namespace graze
