// Estimates are read from a result file as they were written.

#include "graze/results/result_table.hpp"

#include "base/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace graze::estimate_rows_test {

RunRecord identified(const std::string& name) {
    RunRecord run;
    run.name = name;
    run.kind = "identify";
    run.directions = {""};
    return run;
}

TEST(EstimateRows, AreReadAsWritten) {
    testing::TemporaryFolder folder;
    ResultFile file(folder / "r.sqlite", ResultFile::Access::write);
    file.begin_run(identified("a"));
    file.begin_run(identified("b"));
    const EstimateRecords found{{{"w0", "rad/s", {95.94, 0.01, 57}, ""}, {"zeta", "", {0.016, 0, 0}, "not determined"}},
                                {1e-4, -2e-9, -2e-9, 0}};
    file.set_estimates("a", found);
    file.set_estimates("a", found); // replaces the earlier estimates
    file.set_estimates("b", {{{"e", "", {0.8, 0.1, 3}, ""}}, {}});
    const EstimateRecords read = file.estimates("a");
    ASSERT_EQ(read.numbers.size(), 2);
    const auto contents_of = [](const EstimateRecord& number) {
        const Estimate& estimate = number.estimate;
        return std::tuple(number.name, number.unit, number.note, estimate.value, estimate.error, estimate.freedom);
    };
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_EQ(contents_of(read.numbers[i]), contents_of(found.numbers[i]));
    EXPECT_EQ(read.covariance, found.covariance);
    EXPECT_TRUE(file.estimates("b").covariance.empty());
    {
        auto rows = file.query("SELECT low, high FROM estimates WHERE name = 'w0'");
        ASSERT_TRUE(rows.next());
        EXPECT_EQ(rows.number(0), 95.94 - found.numbers[0].estimate.half_width());
        EXPECT_EQ(rows.number(1), 95.94 + found.numbers[0].estimate.half_width());
    }
    ResultTableRequest request;
    request.what = "covariances";
    ResultTable pairs = result_table(file, request);
    std::vector<std::string> read_pairs;
    while (pairs.rows.next())
        read_pairs.push_back(pairs.rows.text(0) + " " + pairs.rows.text(1) + " " + pairs.rows.text(2));
    EXPECT_EQ(read_pairs, (std::vector<std::string>{"a w0 w0", "a w0 zeta", "a zeta w0", "a zeta zeta"}));
    request.what = "estimates";
    request.runs = {"b"};
    ResultTable one = result_table(file, request);
    ASSERT_TRUE(one.rows.next());
    EXPECT_EQ(one.rows.text(1), "e");
    EXPECT_EQ(one.rows.number(3), 0.8);
    EXPECT_FALSE(one.rows.next());
    RunRecord other = identified("c");
    other.kind = "record";
    file.begin_run(other);
    request.runs = {"c"};
    EXPECT_THROW(result_table(file, request), InputError);
    file.remove_run("a");
    EXPECT_TRUE(file.estimates("a").numbers.empty());
    EXPECT_EQ(file.estimates("b").numbers.size(), 1);
    EXPECT_TRUE(file.estimates("none").numbers.empty());
}

} // namespace graze::estimate_rows_test
