#include "branch_results.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/picture/result_picture.hpp"
#include "program/process.hpp"

#include <gmock/gmock.h>

namespace graze::testing::branch_picture_test {

using ::testing::HasSubstr;
using ::testing::Not;

class BranchPicture : public BranchResults {
protected:
    BranchPicture() { write_branches(); }
    static StudyPicture picture_of(const std::string& kind, const std::vector<std::string>& runs) {
        StudyPicture picture;
        picture.kind = kind;
        picture.name = "picture";
        picture.runs = runs;
        return picture;
    }
    Figure drawn(const StudyPicture& picture) const {
        const ResultFile file(path, ResultFile::Access::read);
        return make_picture(picture, file).figure;
    }
    static std::vector<const FigureSeries*> lines_of(const FigurePanel& panel) {
        std::vector<const FigureSeries*> lines;
        for (const FigureSeries& series : panel.series)
            if ((series.style == FigureSeries::Style::line || series.style == FigureSeries::Style::dashed) &&
                !series.only_in_legend)
                lines.push_back(&series);
        return lines;
    }
    static std::vector<double> xs(const FigureSeries& series) {
        std::vector<double> values;
        for (const PlanePoint& point : series.points)
            values.push_back(point.x);
        return values;
    }
};

TEST_F(BranchPicture, LinesChangeTheirStyleWithStability) {
    const Figure figure = drawn(picture_of("", {"first"}));
    ASSERT_EQ(figure.panels.size(), 2U);
    const FigurePanel& panel = figure.panels[0];
    EXPECT_EQ(panel.x_label, "g");
    EXPECT_EQ(panel.x_unit, "m/s^2");
    EXPECT_EQ(panel.y_label, "height");
    const auto lines = lines_of(panel);
    ASSERT_EQ(lines.size(), 5U);
    EXPECT_EQ(xs(*lines[0]), (std::vector<double>{1.6, 1.5, 1.4}));
    EXPECT_EQ(lines[0]->colour, FigureSeries::grey);
    EXPECT_EQ(xs(*lines[1]), (std::vector<double>{1, 1.5, 2}));
    EXPECT_EQ(lines[1]->style, FigureSeries::Style::line);
    EXPECT_EQ(lines[1]->points[2].y, 0.25);
    EXPECT_EQ(xs(*lines[2]), (std::vector<double>{2, 1.8, 1.6}));
    EXPECT_EQ(lines[2]->style, FigureSeries::Style::dashed);
    EXPECT_EQ(xs(*lines[3]), (std::vector<double>{1, 0.9})); // the other part begins anew
    EXPECT_EQ(xs(*lines[4]), (std::vector<double>{0.9, 0.8}));
    EXPECT_EQ(lines[4]->style, FigureSeries::Style::dashed);
    // The monitor named `period` has its own column beside the orbit's period.
    EXPECT_EQ(lines_of(figure.panels[1])[1]->points[2].y, 1);
}

TEST_F(BranchPicture, SpecialPointsAreMarkedAndLabelled) {
    const FigurePanel panel = drawn(picture_of("branch", {"first"})).panels[0];
    std::vector<std::string> texts;
    for (const FigureLabel& label : panel.labels)
        texts.push_back(label.text);
    std::sort(texts.begin(), texts.end());
    EXPECT_EQ(texts, (std::vector<std::string>{"GR1", "PD1", "SN1"}));
    const Figure figure{"", 1, {panel}};
    const std::string script = figure_script(figure, "svg", "out.svg");
    for (const char* text : {"set label \"SN1\" at screen", "set label \"GR1\"", "set label \"PD1\"",
                             "set label \"unphysical\"", "set label \"unstable\""})
        EXPECT_THAT(script, HasSubstr(text));
    EXPECT_THAT(script, Not(HasSubstr("EP1")));
}

TEST_F(BranchPicture, LabelsDoNotOverlap) {
    FigurePanel panel;
    panel.series.push_back({"", FigureSeries::Style::line, 0, {{0, 0}, {1, 1}}});
    for (int i = 0; i < 60; ++i)
        panel.labels.push_back({{0.5, 0.05 + 0.015 * i}, "GR" + std::to_string(i)});
    panel.labels.push_back({{0.1, 0.9}, "SN1", FigureSeries::black, -1});
    panel.labels.push_back({{7, 7}, "far"});
    const std::string script = figure_script(Figure{"", 1, {panel}}, "svg", "out.svg");
    EXPECT_THAT(script, HasSubstr("\"GR0\""));
    EXPECT_THAT(script, HasSubstr("\"SN1\""));
    EXPECT_THAT(script, Not(HasSubstr("\"far\"")));
    std::size_t labels = 0;
    for (std::size_t at = script.find("set label \"GR"); at != std::string::npos;
         at = script.find("set label \"GR", at + 1))
        ++labels;
    EXPECT_GT(labels, 4U);
    EXPECT_LT(labels, 32U); // labels placed in the panel, and the list of the others
}

TEST_F(BranchPicture, SeveralRunsShareAPanel) {
    StudyPicture picture = picture_of("branch", {"first", "second"});
    picture.y = {"period"};
    const Figure figure = drawn(picture);
    ASSERT_EQ(figure.panels.size(), 1U);
    const auto lines = lines_of(figure.panels[0]);
    EXPECT_EQ(lines.back()->colour, 1U);
    EXPECT_EQ(lines.back()->points.back().y, 1.6);
    std::vector<std::string> titles;
    for (const FigureSeries& series : figure.panels[0].series)
        if (series.only_in_legend)
            titles.push_back(series.title);
    EXPECT_EQ(titles, (std::vector<std::string>{"first", "second", "stable", "unstable", "unphysical", "SN: fold",
                                                "PD: flip", "GR: grazing"}));
}

TEST_F(BranchPicture, AxesCanBeChosen) {
    StudyPicture picture = picture_of("branch", {"first"});
    picture.x = "height";
    picture.y = {"multiplier", "period - 1"};
    picture.directions = {"down"};
    const Figure figure = drawn(picture);
    ASSERT_EQ(figure.panels.size(), 2U);
    const auto lines = lines_of(figure.panels[0]);
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0]->points[0].x, 0.5);
    EXPECT_EQ(lines[0]->points[0].y, 0.5);
    EXPECT_EQ(lines[1]->points[1].y, 1.5);
    EXPECT_EQ(lines_of(figure.panels[1])[0]->points[0].y, 1);
}

TEST_F(BranchPicture, PortraitsShowChosenOrbits) {
    StudyPicture picture = picture_of("portrait", {"first"});
    EXPECT_EQ(drawn(picture).panels.size(), 3U); // SN1, GR1 and PD1
    picture.points = {"SN1", "9"};
    picture.at = {{"g", 1.05}};
    const Figure figure = drawn(picture);
    ASSERT_EQ(figure.panels.size(), 3U);
    EXPECT_EQ(figure.panels[0].x_label, "x");
    EXPECT_EQ(figure.panels[0].y_label, "v");
    EXPECT_THAT(figure.panels[0].title, HasSubstr("SN1: g = 2"));
    EXPECT_THAT(figure.panels[1].title, HasSubstr("point 9: g = 0.8"));
    EXPECT_THAT(figure.panels[2].title, HasSubstr("EP1: g = 1"));
    const FigureSeries& curve = figure.panels[1].series[0];
    EXPECT_EQ(curve.title, "1 flight → bounce");
    for (const PlanePoint& point : curve.points)
        EXPECT_NEAR(point.x, (1 - point.y * point.y) / 1.6, 1e-14);
    const StudyPicture whole = picture_of("", {"alone"});
    EXPECT_EQ(drawn(whole).panels.at(0).title, "alone");
}

TEST_F(BranchPicture, HistoriesShareTheirPanels) {
    StudyPicture picture = picture_of("history", {"first"});
    picture.points = {"SN1", "PD1"};
    picture.y = {"x", "energy"};
    const Figure figure = drawn(picture);
    ASSERT_EQ(figure.panels.size(), 2U);
    EXPECT_EQ(figure.panels[1].y_unit, "m^2/s^2");
    EXPECT_EQ(figure.panels[0].x_unit, "s");
    const FigureSeries& curve = figure.panels[0].series[0];
    EXPECT_THAT(curve.title, HasSubstr("SN1"));
    EXPECT_EQ(curve.points.back().x, 1);
}

TEST_F(BranchPicture, GrazePlotDrawsBranches) {
    const auto plotted = [&](const std::vector<std::string>& options) {
        std::vector<std::string> words{"plot", path, "--output", folder / "p.svg", "--data", folder / "p.gp"};
        words.insert(words.end(), options.begin(), options.end());
        done(words);
        return contents(folder / "p.gp");
    };
    EXPECT_THAT(plotted({"--run", "first,second", "--y", "period"}), HasSubstr("set label \"second\""));
    EXPECT_THAT(plotted({}), HasSubstr("set label \"first\"")); // all branches together
    EXPECT_THAT(plotted({"--run", "first", "--point", "GR1"}),
                HasSubstr("GR1:\u00a0\u200b{/:Italic g}\u200b\u00a0= 1.6 m/s^{2}"));
    EXPECT_THAT(plotted({"--run", "first", "--kind", "scatter", "--x", "g", "--y", "height"}), HasSubstr("height"));
    EXPECT_GT(std::filesystem::file_size(folder / "p.svg"), 2'000U);
}

TEST_F(BranchPicture, WrongOptionsAreRefused) {
    write_sweep();
    const auto said = [&](const std::vector<std::string>& options) {
        std::vector<std::string> words{"plot", path, "--output", folder / "no.svg"};
        words.insert(words.end(), options.begin(), options.end());
        const Printed run = run_graze(words);
        EXPECT_EQ(run.code, 2);
        return run.err;
    };
    EXPECT_THAT(said({"--run", "first", "--y", "hight"}), HasSubstr("did you mean 'height'?"));
    EXPECT_THAT(said({"--run", "first", "--kind", "basin"}), HasSubstr("choose branch, portrait, history or scatter"));
    EXPECT_THAT(said({"--run", "first", "--kind", "spectrum"}), HasSubstr("choose branch"));
    EXPECT_THAT(said({"--run", "swept", "--kind", "branch"}), HasSubstr("of kind sweep"));
    EXPECT_THAT(said({"--run", "first,swept"}), HasSubstr("choose one by --run"));
    EXPECT_THAT(said({"--run", "first", "--point", "GR9"}), HasSubstr("GR1"));
    EXPECT_THAT(said({"--run", "swept", "--point", "GR1"}), HasSubstr("--at NAME=VALUE"));
    EXPECT_THAT(said({"--run", "first", "--kind", "portrait", "--at", "h=1"}), HasSubstr("no parameter 'h'"));
    EXPECT_THAT(said({"--run", "first", "--direction", "sideways"}), HasSubstr("sideways"));
    EXPECT_FALSE(std::filesystem::exists(folder / "no.svg"));
}

} // namespace graze::testing::branch_picture_test
