#include "graze/picture/result_picture.hpp"
#include "graze/study/stored_study.hpp"

#include "study/study_of_every_kind.hpp"

#include <map>

namespace graze::stored_picture_test {

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

/// The horizontal coordinates of the stored points of a run, by their numbers.
std::map<std::size_t, double> coordinates_of(const ResultFile& file, const RunRecord& run) {
    std::map<std::size_t, double> coordinates;
    if (run.is_branch())
        for (const OrbitRecord& orbit : file.orbits(run.name, false))
            coordinates[orbit.number] = orbit.point.parameter;
    else
        file.each_point(run.name,
                        [&](const PointRecord& point) { coordinates[point.number] = point.coordinates.front(); });
    return coordinates;
}

TEST_F(StoredPictures, LeadBackToTheStoredPoints) {
    run_and_forget();
    const ResultFile file(path("results.sqlite"), ResultFile::Access::read);
    std::vector<StudyPicture> pictures;
    for (const RunRecord& run : file.runs()) {
        pictures.push_back(default_picture(run));
        if (run.kind != "sweep")
            continue;
        pictures.push_back(default_picture(run));
        pictures.back().kind = "regression";
        pictures.back().y = {"v"};
    }
    std::size_t kinds = 0, labels = 0;
    for (const StudyPicture& picture : pictures) {
        const RunRecord run = *file.find_run(picture.runs.front());
        if (picture.kind == "portrait" || picture.kind == "history")
            continue;
        std::size_t checked = 0;
        const std::map<std::size_t, double> coordinates = coordinates_of(file, run);
        const Figure figure = make_picture(picture, file).figure;
        for (const FigurePanel& panel : figure.panels) {
            for (const FigureSeries& series : panel.series) {
                if (series.run.empty() && picture.kind == "regression")
                    continue; // the line
                ASSERT_EQ(series.numbers.size(), series.points.size()) << run.name << series.title;
                for (std::size_t i = 0; i < series.points.size(); ++i, ++checked) {
                    ASSERT_EQ(series.run, run.name);
                    EXPECT_EQ(series.points[i].x, coordinates.at(series.numbers[i])) << run.name;
                }
            }
            for (const FigureLabel& label : panel.labels) {
                EXPECT_EQ(label.text, file.orbit(label.run, label.number)->label);
                ++labels;
            }
        }
        EXPECT_GT(checked, 5U) << run.name;
        ++kinds;
    }
    EXPECT_EQ(kinds, 4U); // branch, bifurcation diagram, regression, scatter
    EXPECT_GE(labels, 1U);
}

TEST_F(StoredPictures, OfMotionsLeadBackToTheirPoint) {
    run_and_forget();
    const ResultFile file(path("results.sqlite"), ResultFile::Access::read);
    std::size_t orbits = 0, motions = 0;
    for (const RunRecord& run : file.runs()) {
        StudyPicture picture = default_picture(run);
        if (run.kind == "identify")
            continue;
        picture.kind = "history";
        for (const FigurePanel& panel : make_picture(picture, file).figure.panels)
            for (const FigureSeries& series : panel.series) {
                if (series.only_in_legend)
                    continue;
                ASSERT_EQ(series.numbers.size(), series.points.size()) << run.name << series.title;
                EXPECT_EQ(series.run, run.name);
                for (const std::size_t number : series.numbers)
                    EXPECT_EQ(number, series.numbers.front());
                if (!series.numbers.empty()) {
                    EXPECT_TRUE(run.is_branch() ? file.orbit(run.name, series.numbers.front()).has_value()
                                                : file.point(run.name, series.numbers.front()).has_value());
                }
                ++(run.is_branch() ? orbits : motions);
            }
    }
    EXPECT_GT(orbits, 2U);
    EXPECT_GT(motions, 2U);
}

} // namespace graze::stored_picture_test
