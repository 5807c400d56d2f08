#pragma once

#include "graze/picture/figure.hpp"
#include "graze/results/result_file.hpp"
#include "graze/results/table.hpp"
#include "graze/study/study.hpp"

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

} // namespace graze
