#include "page/table_json.hpp"

#include "page/page_results.hpp"

namespace graze {
namespace {

class TableJson : public testing::PageResults {};

TEST_F(TableJson, HasNumbersTextsAndWhatIsMissing) {
    Table table{{"name", ""}, {"speed", "m/s"}};
    table.add("one", 2.5);
    table.add("two", std::numeric_limits<double>::quiet_NaN());
    const nlohmann::json json = table_json("both", table);
    EXPECT_EQ(json["title"], "both");
    EXPECT_EQ(json["columns"],
              nlohmann::json::parse(R"([{"name": "name", "unit": ""}, {"name": "speed", "unit": "m/s"}])"));
    EXPECT_EQ(json["rows"], nlohmann::json::parse(R"([["one", 2.5], ["two", null]])"));
}

TEST_F(TableJson, HasTheFirstRowsOfAQuery) {
    const auto query = [&] { return file().query("SELECT 1 AS n, 'a' AS t, NULL AS m UNION ALL SELECT 2.5, 'b', 3"); };
    const nlohmann::json all = table_json("", query(), {"V"});
    EXPECT_EQ(all["rows"], nlohmann::json::parse(R"([[1, "a", null], [2.5, "b", 3]])"));
    EXPECT_EQ(all["columns"][0]["unit"], "V");
    EXPECT_EQ(all["columns"][2]["unit"], "");
    EXPECT_FALSE(all["left_out"]);
    const nlohmann::json first = table_json("", query(), {}, 1);
    EXPECT_EQ(first["rows"].size(), 1U);
    EXPECT_TRUE(first["left_out"]);
}

} // namespace
} // namespace graze
