#include "graze/results/stored_run.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/results/result_table.hpp"

#include "base/message_of.hpp"
#include "base/temporary_folder.hpp"
#include "run_of_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>

namespace graze::stored_run_test {

using ::testing::ElementsAre;
using ::testing::Pair;

/// A sweep over omega in both directions, whose values have the same names as columns and coordinates.
class StoredRunTest : public ::testing::Test {
protected:
    StoredRunTest() {
        RunRecord run = testing::run_of(load_model("impact-oscillator"), "r", "sweep");
        run.coordinates = {{"omega", "rad/s"}, {"e", ""}};
        for (ResultColumn& state : run.states)
            state.unit = "m";
        run.values = {{"v", "m/s"}, {"omega", "1"}, {"time", "s"}};
        run.samplings = {"low", "it's"};
        run.directions = {"up", "down"};
        file_->begin_run(run);
        for (std::size_t number = 0; number < 4; ++number)
            file_->add_point("r", point_numbered(number));
        file_->flush();
    }
    static PointRecord point_numbered(std::size_t number) {
        const auto n = static_cast<double>(number);
        PointRecord point;
        point.number = number;
        point.direction = number < 2 ? 0 : 1;
        point.coordinates = {number < 2 ? 1 + n : 4 - n, 0.5};
        point.result.label = number == 3 ? Label::chaotic : Label::periodic;
        point.result.state = {n, 0, 0};
        point.result.samples.width = 3;
        for (std::size_t s = 0; s < number; ++s) { // the first point has no samples
            point.result.samples.samplings.push_back(s % 2);
            point.result.samples.times.push_back(0.25 * static_cast<double>(s));
            for (const double value : {10 * n + static_cast<double>(s), -n, 7.0})
                point.result.samples.values.push_back(value);
        }
        return point;
    }
    StoredRun run() const { return {*file_, "r", {}}; }
    static std::vector<double> column(ResultFile::Rows rows, std::size_t index) {
        std::vector<double> values;
        while (rows.next())
            values.push_back(rows.number(index));
        return values;
    }

    testing::TemporaryFolder folder_;
    std::unique_ptr<ResultFile> file_ =
        std::make_unique<ResultFile>(folder_ / "results.sqlite", ResultFile::Access::write);
};

TEST_F(StoredRunTest, ColumnsHaveNamesUnitsAndTypes) {
    const std::vector<StoredColumn> points = run().columns(false), samples = run().columns(true);
    EXPECT_EQ(points.front().name, "number");
    EXPECT_EQ(points.front().type, ColumnType::whole);
    EXPECT_EQ(points[3].name, "omega");
    EXPECT_EQ(points[3].unit, "rad/s");
    EXPECT_EQ(points.back().name, "end_theta");
    EXPECT_EQ(points.back().unit, "m");
    ASSERT_EQ(samples.size(), 6u);
    EXPECT_EQ(samples[1].type, ColumnType::text);
    EXPECT_EQ(samples[5].name, "time_2"); // since the table has a column of this name
    EXPECT_EQ(samples[5].unit, "s");
    EXPECT_EQ(run().unit("v"), "m/s");
    EXPECT_EQ(run().unit("label"), "");
}

TEST_F(StoredRunTest, RunsAndRowsKeepTheFileOpen) {
    std::optional<StoredRun> read = run();
    file_.reset(); // this handle; the run has another
    EXPECT_EQ(read->points(), 4u);
    ResultFile::Rows rows = read->rows({.quantities = {"omega"}});
    read.reset();
    EXPECT_THAT(column(std::move(rows), 0), ElementsAre(1, 2, 2, 1));
}

TEST_F(StoredRunTest, ReadsPointsByDirection) {
    EXPECT_THAT(column(run().rows({.quantities = {"omega"}}), 0), ElementsAre(1, 2, 2, 1));
    EXPECT_THAT(column(run().rows({.columns = {"number"}, .directions = {"down"}}), 0), ElementsAre(2, 3));
    EXPECT_THAT(column(run().rows({.quantities = {"omega * 2 + e"}}), 0), ElementsAre(2.5, 4.5, 4.5, 2.5));
}

TEST_F(StoredRunTest, ReadsSamplesWithColumnsOfTheirPoints) {
    EXPECT_THAT(column(run().rows({.samples = true, .quantities = {"omega"}, .values = {"v"}}), 1),
                ElementsAre(10, 20, 21, 30, 31, 32));
    // A value can have the same name as a coordinate; `values` then selects the value.
    EXPECT_THAT(column(run().rows({.samples = true, .values = {"omega"}}), 0), ElementsAre(-1, -2, -2, -3, -3, -3));
    EXPECT_THAT(column(run().rows({.samples = true, .values = {"v"}, .samplings = {"it's"}}), 0), ElementsAre(21, 31));
    EXPECT_THAT(column(run().rows({.samples = true, .columns = {"time"}, .directions = {"up"}}), 0), ElementsAre(0));
    EXPECT_THAT(column(run().rows({.samples = true, .values = {"v"}, .sorted_by = "omega"}), 0),
                ElementsAre(30, 31, 32, 10, 20, 21));
}

TEST_F(StoredRunTest, SummarisesSamplesByPoint) {
    auto rows = run().rows({.columns = {"number"}, .statistics = {"v"}});
    ASSERT_TRUE(rows.next());
    EXPECT_TRUE(rows.is_null(1)); // a point without samples has a row too
    ASSERT_TRUE(rows.next());
    ASSERT_TRUE(rows.next());
    EXPECT_EQ(rows.number(1), 20.5);
    EXPECT_EQ(rows.number(2), 20);
    EXPECT_EQ(rows.number(3), 21);
}

TEST_F(StoredRunTest, CountsAndFindsPoints) {
    EXPECT_EQ(run().points(), 4u);
    EXPECT_THAT(run().label_counts(), ElementsAre(Pair("periodic", 3u), Pair("chaotic", 1u)));
    EXPECT_EQ(run().extent("omega"), std::pair(1.0, 2.0));
    EXPECT_FALSE(run().extent("e"));
    EXPECT_EQ(run().nearest({{"omega", 1.1}}, {}), 0u);
    EXPECT_EQ(run().nearest({{"omega", 1.1}}, {"down"}), 3u);
    EXPECT_EQ(run().nearest({}, {"up"}), 1u);
    EXPECT_FALSE(run().nearest({}, {"sideways"}));
    EXPECT_THROW(run().nearest({{"sigma", 1}}, {}), InputError);
    EXPECT_TRUE(run().parts().empty());
}

TEST_F(StoredRunTest, TablesHaveUnits) {
    ResultTable table = result_table(*file_, {.what = "samples", .direction = "down"});
    ASSERT_EQ(table.rows.columns(), 9u);
    EXPECT_EQ(table.rows.column_name(2), "omega");
    EXPECT_EQ(table.units[2], "rad/s");
    EXPECT_EQ(table.units[6], "m/s");
    std::size_t rows = 0;
    while (table.rows.next())
        ++rows;
    EXPECT_EQ(rows, 5u);
    // A value with the name of a coordinate or of a column of samples does not hide it.
    std::vector<std::string> names;
    for (std::size_t c = 0; c < table.rows.columns(); ++c)
        names.push_back(table.rows.column_name(c));
    EXPECT_THAT(names, ElementsAre("point", "direction", "omega", "e", "sampling", "time", "v", "omega_2", "time_2"));
    ResultTable chaotic = result_table(*file_, {.what = "points", .label = "chaotic"});
    ASSERT_TRUE(chaotic.rows.next());
    EXPECT_FALSE(chaotic.rows.next());
    EXPECT_THROW(result_table(*file_, {.what = "point"}), InputError);
    EXPECT_THROW(result_table(*file_, {.runs = {"s"}}), InputError);
    EXPECT_THROW(result_table(*file_, {.what = "segments"}), InputError);
}

TEST_F(StoredRunTest, RunsOnlyOneQuery) {
    for (const char* expression : {"1; DROP TABLE runs", "(DELETE FROM runs)", "none_such", "load_extension('x')"})
        EXPECT_THROW(run().rows({.quantities = {expression}}), InputError) << expression;
    EXPECT_EQ(file_->runs().size(), 1u);
}

TEST_F(StoredRunTest, ReadsOneExpressionOfItsOwnRows) {
    const std::string of_others = "number FROM runs p";
    const std::vector<std::string> wrong{of_others + " --",
                                         of_others + "; ",
                                         of_others + "/*",
                                         "omega AS e",
                                         "1, 2",
                                         "omega) FROM (SELECT 1 AS omega",
                                         "(1",
                                         "1)",
                                         ")(",
                                         "'a",
                                         std::string("omega\0", 6)};
    for (const std::string& text : wrong)
        EXPECT_THROW(run().rows({.quantities = {text}}), InputError) << text;
    EXPECT_THAT(column(run().rows({.quantities = {"max(omega, (1.5))"}}), 0), ElementsAre(1.5, 2, 2, 1.5));
    EXPECT_THAT(column(run().rows({.quantities = {"length('a;--(''/*')"}}), 0), ElementsAre(8, 8, 8, 8));
}

TEST_F(StoredRunTest, TakesNoTextForANumber) {
    EXPECT_THROW(column(run().rows({.quantities = {"'12abc'"}}), 0), InputError);
    EXPECT_THROW(run().extent("'abc' || omega"), InputError);
}

TEST_F(StoredRunTest, ABranchVariesAParameterIfTheModelHasAny) {
    RunRecord branch = testing::run_of(load_model("impact-oscillator"), "b", "continue");
    branch.coordinates.clear();
    file_->begin_run(branch);
    file_->flush();
    EXPECT_THAT(testing::message_of([&] { StoredRun(*file_, "b", {}); }),
                ::testing::HasSubstr(file_->path() + ": the result file contradicts itself: run 'b'"));
}

} // namespace graze::stored_run_test
