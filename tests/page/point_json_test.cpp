#include "page/point_json.hpp"

#include "graze/results/orbit_table.hpp"
#include "graze/results/stored_orbit.hpp"
#include "page/json_text.hpp"
#include "page/page_results.hpp"
#include "page/table_json.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {
namespace {

class PointJson : public testing::PageResults {};

TEST_F(PointJson, OfABranchEqualsItsOrbit) {
    const OrbitRecord record = special_point("chain", PointType::end);
    const StoredRun run(file(), "chain", {});
    const OrbitSolution& solution = record.point.solution;
    const nlohmann::json json = nlohmann::json::parse(json_text(point_json(file(), "chain", record.number)));
    EXPECT_EQ(json["kind"], "orbit");
    EXPECT_EQ(json["run"], "chain");
    EXPECT_EQ(json["label"], record.label);
    EXPECT_EQ(json["title"], record.label);
    EXPECT_EQ(json["type"], "EP");
    EXPECT_EQ(json["stable"], record.stable);
    EXPECT_EQ(json["period"], solution.orbit.period());
    EXPECT_EQ(json["signature"], to_string(run.model, solution.orbit.signature));
    EXPECT_EQ(json["coordinates"][0]["name"], "omega");
    EXPECT_EQ(json["coordinates"][0]["value"], record.point.parameter);
    ASSERT_EQ(json["parameters"].size(), run.model.parameters.size());
    for (const nlohmann::json& parameter : json["parameters"])
        if (const auto place = run.model.find_independent_parameter(parameter["name"].get<std::string>())) {
            EXPECT_EQ(parameter["value"], solution.orbit.parameters[place->place()]) << parameter["name"];
        }
    ASSERT_EQ(json["values"].size(), record.point.monitors.size());
    EXPECT_EQ(json["values"][0]["name"], "slowest");
    EXPECT_EQ(json["values"][0]["value"], record.point.monitors[0]);
    ASSERT_EQ(json["multipliers"].size(), solution.multipliers.size());
    for (std::size_t i = 0; i < solution.multipliers.size(); ++i)
        EXPECT_EQ(testing::numbers_in(json["multipliers"][i]),
                  (std::vector{solution.multipliers[i].real(), solution.multipliers[i].imag()}));
    EXPECT_EQ(json["tables"][0], table_json("segments", segment_table(run.model, solution)));
    EXPECT_EQ(json["tables"][1]["rows"].size(), solution.certificate.minima.size());
    EXPECT_EQ(json["tables"][2]["rows"].size(), solution.certificate.end_values.size());
}

TEST_F(PointJson, OfASweepEqualsItsMotion) {
    const PointRecord point = *file().point("sweep", 3);
    const nlohmann::json json = point_json(file(), "sweep", 3);
    EXPECT_EQ(json["kind"], "motion");
    EXPECT_EQ(json["type"], name_of(point.result.label));
    EXPECT_EQ(json["coordinates"][0]["value"], point.coordinates[0]);
    EXPECT_EQ(json["part"], "up");
    for (const nlohmann::json& parameter : json["parameters"])
        if (parameter["name"] == "omega") {
            EXPECT_EQ(parameter["value"], point.coordinates[0]);
        }
    const nlohmann::json& samples = json["tables"][0];
    ASSERT_EQ(samples["rows"].size(), point.result.samples.size());
    EXPECT_EQ(samples["columns"].size(), 2 + file().find_run("sweep")->values.size());
    EXPECT_EQ(samples["rows"][0][1], point.result.samples.times[0]);
    EXPECT_EQ(samples["rows"][0][2], point.result.samples.values[0]);
    EXPECT_FALSE(samples["left_out"]);
}

class MeasuredPointJson : public testing::StudyFixture {};

TEST_F(MeasuredPointJson, HasTheEstimates) {
    std::string release = "t [s], v [m/s]\n";
    for (int i = 0; i < 1500; ++i)
        release += fmt::format("{:.17g},{:.17g}\n", 1e-3 * i, std::exp(-1.5e-3 * i) * std::sin(96e-3 * i));
    folder_.write("r1.csv", release);
    testing::expect_complete(run(R"(name = "s"
model = "electromagnetic-testbed"
[runs.releases]
kind = "record"
files = "r*.csv"
[runs.decay]
kind = "identify"
what = "decrement"
records = "releases"
gives = { natural_frequency = "w0", damping_ratio = "zeta" }
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    const nlohmann::json json = point_json(file, "decay", 0);
    EXPECT_EQ(json["kind"], "record");
    const nlohmann::json& table = json["tables"][0];
    EXPECT_EQ(table["title"], "estimates");
    const EstimateRecords found = file.estimates("decay");
    ASSERT_EQ(table["rows"].size(), found.numbers.size());
    std::size_t name = 0, value = 0;
    for (std::size_t c = 0; c < table["columns"].size(); ++c) {
        name = table["columns"][c]["name"] == "name" ? c : name;
        value = table["columns"][c]["name"] == "value" ? c : value;
    }
    for (std::size_t i = 0; i < found.numbers.size(); ++i) {
        EXPECT_EQ(table["rows"][i][name], found.numbers[i].name);
        EXPECT_EQ(table["rows"][i][value], found.numbers[i].estimate.value);
    }
    EXPECT_EQ(point_json(file, "releases", 0)["kind"], "record");
}

TEST_F(PointJson, IsRefusedWhereThereIsNone) {
    EXPECT_THROW(point_json(file(), "nothing", 0), InputError);
    EXPECT_THROW(point_json(file(), "chain", 100'000), InputError);
    EXPECT_THROW(point_json(file(), "sweep", 100'000), InputError);
    EXPECT_THROW(point_json(file(), "sweep", std::numeric_limits<std::size_t>::max()), InputError);
    EXPECT_THROW(point_json(file(), "chain", std::numeric_limits<std::size_t>::max()), InputError);
}

} // namespace
} // namespace graze
