#pragma once

#include "graze/picture/figure.hpp"
#include "graze/results/result_file.hpp"
#include "graze/results/table.hpp"
#include "graze/study/study.hpp"

namespace graze {

/// A picture made from results, and a table of the numbers that were computed for it; the table may be empty.
struct ResultPicture {
    Figure figure;
    Table table{};
};

/// Makes a picture from results. @throws InputError when the results lack something that the picture asks for
ResultPicture make_picture(const StudyPicture& picture, const ResultFile& file);
/// The picture of a run when the study describes none; it depends on the kind of the run.
StudyPicture default_picture(const RunRecord& run);
/// Whether a run is drawn where no picture is described: those that an atlas has made ("map.branch1") are not, since
/// the picture of the atlas shows them.
bool has_own_picture(const RunRecord& run, const ResultFile& file);

} // namespace graze
