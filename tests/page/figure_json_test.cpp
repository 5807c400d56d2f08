#include "page/figure_json.hpp"

#include "graze/picture/result_picture.hpp"
#include "page/json_text.hpp"
#include "page/page_results.hpp"

namespace graze {
namespace {

class FigureJson : public testing::PageResults {};

TEST_F(FigureJson, HasAllThatAFigureSays) {
    Figure figure{.title = "<b>", .columns = 2, .symbols = {"x"}};
    figure.style.width = 85;
    figure.style.grey = true;
    FigurePanel panel{.title = "(a)",
                      .x_label = "V",
                      .y_label = "v",
                      .x_unit = "V",
                      .x_words = "voltage",
                      .logarithmic_y = true,
                      .x_range = {{1, 2}}};
    FigureSeries line{"stable", FigureSeries::Style::dashed, FigureSeries::grey};
    line.points = {{1, 2}, {std::numeric_limits<double>::quiet_NaN(), 3}};
    line.corners = {1};
    line.along = {0, 0.5};
    panel.series.push_back(line);
    FigureSeries cells{"period 1", FigureSeries::Style::cells, 3};
    cells.cells = {{0, 1, 2, 3}};
    cells.run = "map";
    cells.numbers = {17};
    panel.series.push_back(cells);
    panel.marks = {1.5};
    panel.labels.push_back({{1, 2}, "GR1", 0, 2, "up", "chain", 5});
    panel.labels.push_back({{1, 3}, "stop"});
    figure.panels.push_back(panel);
    const nlohmann::json json = figure_json(figure);
    EXPECT_EQ(json["title"], "<b>");
    EXPECT_EQ(json["columns"], 2);
    EXPECT_EQ(json["style"]["width"], 85);
    EXPECT_EQ(json["style"]["grey"], true);
    const nlohmann::json& shown = json["panels"][0];
    EXPECT_EQ(shown["x"],
              nlohmann::json::parse(
                  R"({"label": "V", "unit": "V", "words": "voltage", "logarithmic": false, "range": [1, 2]})"));
    EXPECT_TRUE(shown["y"]["range"].is_null());
    EXPECT_EQ(shown["y"]["logarithmic"], true);
    EXPECT_EQ(shown["marks"], nlohmann::json::parse("[1.5]"));
    const nlohmann::json &dashed = shown["series"][0], &filled = shown["series"][1];
    EXPECT_EQ(dashed["style"], "dashed");
    EXPECT_EQ(dashed["colour"], "grey");
    EXPECT_EQ(dashed["x"], nlohmann::json::parse("[1, null]"));
    EXPECT_EQ(dashed["y"], nlohmann::json::parse("[2, 3]"));
    EXPECT_EQ(dashed["corners"], nlohmann::json::parse("[1]"));
    EXPECT_EQ(dashed["along"], nlohmann::json::parse("[0, 0.5]"));
    EXPECT_FALSE(filled.contains("along"));
    EXPECT_FALSE(dashed.contains("run"));
    EXPECT_EQ(filled["cells"], nlohmann::json::parse("[[0, 1, 2, 3]]"));
    EXPECT_EQ(filled["numbers"], nlohmann::json::parse("[17]"));
    EXPECT_EQ(filled["run"], "map");
    EXPECT_EQ(shown["labels"][0]["number"], 5);
    EXPECT_EQ(shown["labels"][0]["run"], "chain");
    EXPECT_EQ(shown["labels"][0]["rank"], 2);
    EXPECT_FALSE(shown["labels"][1].contains("run"));
    EXPECT_EQ(shown["labels"][1]["colour"], "black");
}

TEST_F(FigureJson, LeadsBackToTheOrbitsOfABranch) {
    const Figure figure = make_picture(default_picture(*file().find_run("chain")), file()).figure;
    const nlohmann::json json = nlohmann::json::parse(json_text(figure_json(figure)));
    std::size_t checked = 0;
    for (const nlohmann::json& series : json["panels"][0]["series"])
        for (std::size_t i = 0; i < series["x"].size(); ++i, ++checked) {
            const auto orbit = file().orbit(series["run"], series["numbers"][i].get<std::size_t>());
            ASSERT_TRUE(orbit);
            EXPECT_EQ(series["x"][i].get<double>(), orbit->point.parameter);
        }
    EXPECT_GT(checked, 10U);
}

TEST_F(FigureJson, HoldsAllOfManyPoints) {
    Figure figure;
    FigureSeries series{.run = "sweep"};
    for (std::size_t i = 0; i < 200'000; ++i)
        series.add({1.0 / static_cast<double>(i + 3), std::sin(static_cast<double>(i))}, i / 10);
    figure.panels.emplace_back().series.push_back(std::move(series));
    EXPECT_GT(json_text(figure_json(figure)).size(), 200'000U * 40);
}

} // namespace
} // namespace graze
