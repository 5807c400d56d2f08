// Designs from the command line: what they write, print and refuse.

#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

namespace graze::testing {

using ::testing::HasSubstr;

namespace {

/// A design with few points, which takes little time.
std::string small_design(const std::string& rest = "") {
    return R"(name = "small"
model = "mems-switch"
control = "V"
adjustable = "delta"
[approach]
from = { q = 0, v = 0, theta = 0 }
range = [0.05, 0.4]
[trip]
overshoots = [1e-4]
[dimensions.delta]
range = [0.5, 0.7]
tolerance = "1%"
[dimensions.zeta]
range = [0.01, 0.03]
[points]
curve = 3
plane = 3
[yield]
devices = 20
within = [0.19, 0.21]
)" + rest;
}

struct DesignCommand : public ::testing::Test {
    std::string design(const std::string& text) const {
        const std::string path = folder / "small.toml";
        std::ofstream(path) << text;
        return path;
    }
    Folder folder;
};

} // namespace

TEST_F(DesignCommand, WritesTablesAPageAndTheDevice) {
    const std::string results = folder / "results";
    const Printed printed = run_graze({"design", design(small_design()), "--output", results, "--format", "csv"});
    ASSERT_EQ(printed.code, 0) << printed.err;
    EXPECT_THAT(printed.out, HasSubstr("trip_value,0.20136621215412"));
    EXPECT_THAT(printed.out, HasSubstr("class,trips"));
    for (const char* name :
         {"facts.csv", "sensitivities.csv", "earlier.csv", "trip-times.csv", "curve-delta.csv", "plane-delta-zeta.csv",
          "tuning.csv", "devices.csv", "report.json", "page.svg", "page.pdf", "device.toml", "results.sqlite"})
        EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(results) / name)) << name;
    // Other commands take what it leaves.
    EXPECT_EQ(run_graze({"check", results + "/device.toml"}).code, 0);
    EXPECT_THAT(run_graze({"grazing", results, "GR1"}).out, HasSubstr("lost"));
    // Done again it prints the same.
    EXPECT_EQ(run_graze({"design", folder / "small.toml", "--output", results, "--format", "csv"}).out, printed.out);
}

TEST_F(DesignCommand, MeetsWishesOrSaysThatItCannot) {
    const std::string results = folder / "results";
    Printed printed = run_graze({"design", design(small_design("[wanted]\nvalue = 0.21\n")), "--output", results,
                                 "--no-pictures", "--format", "csv"});
    ASSERT_EQ(printed.code, 0) << printed.err;
    EXPECT_THAT(printed.out, HasSubstr("wishes,met"));
    EXPECT_TRUE(std::filesystem::exists(results + "/designed.sqlite"));
    printed = run_graze({"design", design(small_design("[wanted]\nvalue = 0.9\n")), "--output", results,
                         "--no-pictures", "--format", "csv"});
    EXPECT_EQ(printed.code, 3);
    EXPECT_THAT(printed.out, HasSubstr("wishes,unmet"));
}

TEST_F(DesignCommand, ListsAndShowsThoseThatComeWithIt) {
    EXPECT_THAT(run_graze("design --list").out, HasSubstr("mems-switch"));
    EXPECT_THAT(run_graze("design mems-switch --show").out, HasSubstr("[dimensions.delta]"));
}

TEST_F(DesignCommand, RefusesMistakesWithTheirPlaces) {
    EXPECT_EQ(run_graze("design").code, 2);
    EXPECT_THAT(run_graze("design mems-swich").err, HasSubstr("mems-switch"));
    const Printed printed = run_graze(
        {"design", design(small_design("[wanted]\nclass = \"x\"\nvalue = \"y\"\n")), "--output", folder / "none"});
    EXPECT_EQ(printed.code, 2);
    EXPECT_THAT(printed.err, HasSubstr("small.toml:22:9"));
    EXPECT_THAT(printed.err, HasSubstr("small.toml:23:"));
    EXPECT_FALSE(std::filesystem::exists(folder / "none"));
}

} // namespace graze::testing
