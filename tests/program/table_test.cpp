#include "program/table.hpp"

#include "run_graze.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace graze::testing::table_test {

std::string written(const Table& table, TableFormat format, int digits = 17) {
    std::ostringstream out;
    JsonObject heading;
    heading.add("model", "a \"quoted\"\nname");
    write_table(out, table, format, digits, heading);
    return out.str();
}

Table small_table() {
    Table table({{"time", "s"}, {"mode", ""}, {"x", "m"}});
    for (const double x : {1.5, std::nan(""), -std::numeric_limits<double>::infinity()}) {
        table.add(0.1);
        table.add("free, really");
        table.add(x);
    }
    return table;
}

TEST(Table, NumbersReadBackExactly) {
    std::mt19937_64 random(7);
    Table table(std::vector<Table::Column>{{"x", ""}});
    std::vector<double> values;
    while (values.size() < 1000) {
        const auto value = std::bit_cast<double>(random());
        if (!std::isfinite(value))
            continue;
        values.push_back(value);
        table.add(value);
    }
    const Csv csv(written(table, TableFormat::csv));
    ASSERT_EQ(csv.rows.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_EQ(csv.number(i, "x"), values[i]);
}

TEST(Table, CsvQuotesAndLeavesMissingCellsEmpty) {
    EXPECT_EQ(written(small_table(), TableFormat::csv), "time,mode,x\n"
                                                        "0.10000000000000001,\"free, really\",1.5\n"
                                                        "0.10000000000000001,\"free, really\",\n"
                                                        "0.10000000000000001,\"free, really\",\n");
    EXPECT_EQ(small_table().incomplete_columns(), std::vector<std::string>{"x"});
}

TEST(Table, TextsInTheLastColumnAreBrokenToFitLines) {
    Table table({{"name", ""}, {"what it does", ""}});
    table.add("one");
    table.add("some words that are longer than a line of so few letters");
    const auto lines = [&](std::size_t longest) {
        std::ostringstream out;
        write_table(out, table, TableFormat::table, 6, {}, longest);
        return out.str();
    };
    EXPECT_EQ(lines(0), "name  what it does\none   some words that are longer than a line of so few letters\n");
    EXPECT_EQ(lines(40), "name  what it does\n"
                         "one   some words that are longer than a\n"
                         "      line of so few letters\n");
    EXPECT_EQ(lines(20), lines(0)) << "the line is too short for breaking";
}

TEST(Table, JsonIsValid) {
    const std::string text = written(small_table(), TableFormat::json, 3);
    EXPECT_TRUE(JsonCheck(text).valid()) << text;
    EXPECT_NE(text.find("\"columns\":[\"time\",\"mode\",\"x\"]"), std::string::npos);
    EXPECT_NE(text.find("\"units\":[\"s\",\"\",\"m\"]"), std::string::npos);
    EXPECT_NE(text.find("[0.1,\"free, really\",null]"), std::string::npos);
    EXPECT_NE(text.find("\"model\":\"a \\\"quoted\\\"\\u000aname\""), std::string::npos);
    EXPECT_TRUE(JsonCheck(written(Table(std::vector<Table::Column>{{"x", ""}}), TableFormat::json)).valid());
}

TEST(Table, AlignsColumns) {
    Table table(std::vector<Table::Column>{{"name", ""}, {"x", "m"}});
    table.add("short");
    table.add(1);
    table.add("much longer");
    table.add(-12.5);
    EXPECT_EQ(written(table, TableFormat::table), "name             x\n"
                                                  "                 m\n"
                                                  "short            1\n"
                                                  "much longer  -12.5\n");
}

TEST(Table, DropsOddRows) {
    for (const int rows : {0, 1, 2, 5, 6}) {
        Table table(std::vector<Table::Column>{{"x", ""}, {"y", ""}});
        for (int i = 0; i < rows; ++i) {
            table.add(i);
            table.add(10 * i);
        }
        table.drop_odd_rows();
        ASSERT_EQ(table.rows(), static_cast<std::size_t>((rows + 1) / 2));
        for (std::size_t i = 0; i < table.rows(); ++i)
            EXPECT_EQ(table.number(i, 1), 20.0 * static_cast<double>(i));
    }
}

} // namespace graze::testing::table_test
