#include "graze/picture/result_picture.hpp"
#include "graze/study/stored_study.hpp"

#include "study/study_of_every_kind.hpp"

namespace graze {
namespace {

class StoredPictures : public testing::StudyOfEveryKind {};

std::vector<PlanePoint> points_of(const Figure& figure) {
    std::vector<PlanePoint> points;
    for (const FigurePanel& panel : figure.panels)
        for (const FigureSeries& series : panel.series)
            points.insert(points.end(), series.points.begin(), series.points.end());
    return points;
}

TEST_F(StoredPictures, CanBeDrawnFromResultsAlone) {
    run_and_forget();
    const ResultFile file(path("results.sqlite"), ResultFile::Access::read);
    const Study study = stored_study(file);
    for (const StudyPicture& picture : study.pictures)
        EXPECT_GT(points_of(make_picture(picture, file).figure).size(), 5u) << picture.name;
    for (const StudyRun& run : study.runs)
        EXPECT_FALSE(points_of(make_picture(default_picture(*file.find_run(run.name)), file).figure).empty())
            << run.name;
}

} // namespace
} // namespace graze
