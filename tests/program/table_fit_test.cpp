#include "program/table_fit.hpp"

#include "branch_results.hpp"
#include "program/table.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace graze::testing::table_fit_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

Table table_with(const std::vector<std::string>& names, const std::string& cell) {
    std::vector<Table::Column> columns;
    for (const std::string& name : names)
        columns.push_back({name, ""});
    Table table(columns);
    for (std::size_t c = 0; c < names.size(); ++c)
        table.add(cell);
    return table;
}

std::vector<std::string> names(const Table& table) {
    std::vector<std::string> result;
    for (const Table::Column& column : table.columns())
        result.push_back(column.name);
    return result;
}

TEST(TableFit, KeepsColumnsThatFit) {
    // Three columns of four characters and two gaps of two.
    const Table table = table_with({"aaaa", "bbbb", "cccc"}, "x");
    const FittedTable whole = fitted(table, 8, 16, {});
    EXPECT_THAT(names(whole.table), ElementsAre("aaaa", "bbbb", "cccc"));
    EXPECT_TRUE(whole.left_out.empty());
    const FittedTable narrow = fitted(table, 8, 15, {});
    EXPECT_THAT(names(narrow.table), ElementsAre("aaaa", "bbbb"));
    EXPECT_THAT(narrow.left_out, ElementsAre("cccc"));
    EXPECT_THAT(names(fitted(table, 8, 15, {"cccc"}).table), ElementsAre("aaaa", "cccc"));
    EXPECT_THAT(names(fitted(table, 8, 1, {}).table), ElementsAre("aaaa"));
    EXPECT_EQ(narrow.table.text(0, 1), "x");
}

TEST(TableFit, LeavesOutEmptyAndUnimportantColumnsFirst) {
    Table table({{"number", ""}, {"chain", ""}, {"nothing", ""}, {"x", ""}, {"missing", ""}});
    table.add(1);
    table.add(2);
    table.add("");
    table.add(0.123456789);
    table.add(std::nan(""));
    EXPECT_THAT(names(fitted(table, 8, 100, {}).table), ElementsAre("number", "chain", "x"));
    const FittedTable narrow = fitted(table, 8, 18, {});
    EXPECT_THAT(names(narrow.table), ElementsAre("number", "x"));
    EXPECT_THAT(narrow.left_out, ElementsAre("chain"));
}

TEST(TableFit, TablesOfCommandsFitATerminalUnlessAllIsGiven) {
    for (const std::string line : {"simulate microbeam --set V=10 --time 1 --samples 5",
                                   "simulate impact-microactuator --periods 2 --contacts"}) {
        const Printed brief = run_graze(line), all = run_graze(line + " --all"),
                      csv = run_graze(line + " --format csv");
        ASSERT_EQ(brief.code, 0) << brief.err;
        std::size_t widest = 0;
        for (const std::string& row : split(brief.out, '\n'))
            EXPECT_LE(row.size(), 100U) << row;
        for (const std::string& row : split(all.out, '\n'))
            widest = std::max(widest, row.size());
        EXPECT_EQ(widest > 100, brief.err.find("--all shows everything") != std::string::npos) << brief.err;
        std::istringstream headings(header(all.out));
        std::size_t columns = 0;
        for (std::string word; headings >> word;)
            ++columns;
        EXPECT_EQ(columns, Csv(csv.out).columns.size());
        EXPECT_THAT(all.err, Not(HasSubstr("left out")));
    }
    const Printed asked = run_graze("simulate impact-microactuator --periods 1 --contacts --quantity 1+1");
    EXPECT_THAT(header(asked.out), HasSubstr("1+1"));
}

TEST(TableFit, ShortensLongSignatures) {
    std::string many, mixed;
    for (int i = 0; i < 24; ++i)
        many += i == 0 ? "impact" : " impact";
    for (int i = 0; i < 24; ++i)
        mixed += i == 0 ? "left right" : " left right";
    EXPECT_EQ(shortened_words("impact full", 40), "impact full");
    EXPECT_EQ(shortened_words("impact impact full", 40), "impact impact full");
    EXPECT_EQ(shortened_words(many + " full", 40), "impact (24 times) full");
    EXPECT_EQ(shortened_words(mixed, 40), "left right left right ... (48 words)");
    Table table({{"signature", ""}, {"value", ""}});
    table.add(mixed);
    table.add(1.0);
    EXPECT_TRUE(fitted(table, 8, 100, {}).shortened);
    EXPECT_LE(fitted(table, 8, 100, {}).table.text(0, 0).size(), 40U);
    EXPECT_EQ(fitted(table, 8, 100, {}).table.number(0, 1), 1.0);
}

} // namespace graze::testing::table_fit_test
