// `graze tolerance`: how the voltage at which the MEMS switch trips depends on its dimensions.

#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

namespace graze::testing::tolerance_command_test {

using ::testing::HasSubstr;
using ::testing::Not;

struct ToleranceCommand : public ::testing::Test {
    void SetUp() override {
        results = folder / "results";
        done({"run", "mems-switch", "--output", results, "--quiet", "--only", "free", "--only", "no_impact", "--only",
              "touches_gap"});
    }
    Printed tolerance(std::vector<std::string> words) const {
        words.insert(words.begin(), {"tolerance", results});
        return run_graze(words);
    }
    Csv table(std::vector<std::string> words) const {
        words.insert(words.end(), {"--format", "csv"});
        return Csv(done(tolerance(words)));
    }
    static double number(const Csv& csv, const std::string& first, const std::string& name, const std::string& column) {
        for (std::size_t row = 0; row < csv.rows.size(); ++row)
            if (csv.text(row, first) == name)
                return std::stod(csv.text(row, column));
        ADD_FAILURE() << name;
        return 0;
    }
    Folder folder;
    std::string results;
};

TEST_F(ToleranceCommand, FindsDerivativesAtAnyTouch) {
    const Csv csv = table({"no_impact:GR1"});
    ASSERT_EQ(csv.rows.size(), 4U);
    // The grazing of a motion without impact does not depend on the restitution.
    EXPECT_EQ(number(csv, "parameter", "e", "dV"), 0);
    const double by_gap = number(csv, "parameter", "delta", "dV");
    EXPECT_NEAR(number(csv, "parameter", "delta", "relative"), by_gap * 0.6 / 0.2013662121541341, 1e-10);
    // A curve of touches begins at the same grazing.
    EXPECT_NEAR(number(table({"touches_gap:EP1", "--parameter", "V"}), "parameter", "delta", "dV"), by_gap, 1e-9);
    // The inverse derivative: of the gap at the grazing by the voltage.
    const Csv inverse = table({"no_impact:GR1", "--parameter", "delta"});
    EXPECT_NEAR(number(inverse, "parameter", "V", "ddelta") * by_gap, 1, 1e-10);
    const Printed people = tolerance({"no_impact:GR1"});
    EXPECT_THAT(people.out, HasSubstr("V = 0.20136621\n"));
}

TEST_F(ToleranceCommand, StatisticsOfDevicesMatchTheDerivatives) {
    const std::vector<std::string> words{
        "no_impact:GR1", "--vary", "delta=1%,zeta=0.001:uniform", "--within", "0.199:0.204", "--devices", "400"};
    const Csv csv = table(words);
    EXPECT_EQ(number(csv, "quantity", "devices", "value"), 400);
    EXPECT_EQ(number(csv, "quantity", "found", "value"), 400);
    const double linear = number(csv, "quantity", "linear_deviation", "value");
    const Csv derivatives = table({"no_impact:GR1"});
    EXPECT_NEAR(linear,
                std::hypot(number(derivatives, "parameter", "delta", "dV") * 0.006,
                           number(derivatives, "parameter", "zeta", "dV") * 0.001 / std::sqrt(3.0)),
                1e-14);
    EXPECT_LT(number(csv, "quantity", "deviation", "low"), linear);
    EXPECT_GT(number(csv, "quantity", "deviation", "high"), linear);
    const double within = number(csv, "quantity", "within", "value");
    EXPECT_GT(within, number(csv, "quantity", "within", "low"));
    EXPECT_LT(within, number(csv, "quantity", "within", "high"));

    std::vector<std::string> alone = words;
    alone.insert(alone.end(), {"--jobs", "1", "--format", "json"});
    const Printed once = tolerance(alone);
    alone[alone.size() - 3] = "3";
    const Printed again = tolerance(alone);
    EXPECT_EQ(once.code, 0);
    EXPECT_EQ(once.out, again.out); // independent of the number of threads
    EXPECT_THAT(once.out, HasSubstr("\"statistics\":{\"nominal\":0.2013662"));
    EXPECT_THAT(once.out, HasSubstr("\"share\""));
    alone.insert(alone.end(), {"--seed", "7"});
    EXPECT_NE(tolerance(alone).out, once.out);
    const Printed people = tolerance(words);
    EXPECT_THAT(people.out, HasSubstr("share of all devices that is wanted"));
    EXPECT_THAT(people.out, HasSubstr("relative"));
    std::vector<std::string> kept = words;
    kept.insert(kept.end(), {"--output", folder / "yield.txt"});
    EXPECT_EQ(tolerance(kept).out, "");
    EXPECT_EQ(contents(folder / "yield.txt"), people.out);
}

TEST_F(ToleranceCommand, DrawsTheDistributionOfDevices) {
    done(tolerance({"no_impact:GR1", "--vary", "delta=1%", "--devices", "300", "--within", "0.2:", "--plot",
                    folder / "yield.svg", "--data", folder / "yield.gnuplot"}));
    EXPECT_THAT(contents(folder / "yield.svg"), HasSubstr("</svg>"));
    EXPECT_TRUE(std::filesystem::exists(folder / "yield.gnuplot"));
    const Printed alike =
        tolerance({"no_impact:GR1", "--vary", "e=1%", "--devices", "10", "--plot", folder / "no.svg"});
    EXPECT_EQ(alike.code, 2);
    EXPECT_THAT(alike.err, HasSubstr("the devices do not differ"));
}

TEST_F(ToleranceCommand, CountsDevicesWithoutASolution) {
    // Some stops lie at or beyond the rest position of the electrode.
    const Printed printed = tolerance({"no_impact:GR1", "--vary", "delta=0.3", "--devices", "200", "--format", "csv"});
    const Csv csv(printed.out);
    const double failed = number(csv, "quantity", "failed", "value");
    EXPECT_EQ(number(csv, "quantity", "found", "value") + number(csv, "quantity", "inadmissible", "value") + failed,
              200);
    EXPECT_EQ(printed.code, failed > 0 ? 3 : 0);
    EXPECT_THAT(printed.err, HasSubstr(" of 200 devices: "));
}

TEST_F(ToleranceCommand, RefusesWrongPointsAndOptions) {
    const auto refused = [&](std::vector<std::string> words, const std::string& why) {
        expect_refusal(tolerance(words), why);
    };
    refused({"no_impact:EP1"}, "nothing that could be held happens at a point of type EP");
    refused({"no_impact:GR9"}, "GR9");
    refused({"no_impact:GR1", "--parameter", "e"}, "POINT: ");
    refused({"no_impact:GR1", "--vary", "delta"}, "no tolerance of any parameter");
    refused({"no_impact:GR1", "--vary", "V=1%"}, "'V' is the parameter whose value follows");
    refused({"no_impact:GR1", "--vary", "delta=1%,delta=2%"}, "'delta' is to be varied twice");
    refused({"no_impact:GR1", "--vary", "delt=1%"}, "delta");
    refused({"no_impact:GR1", "--vary", "delta=1%:flat"}, "'flat' is no way");
    refused({"no_impact:GR1", "--vary", "delta=-1%"}, "below zero");
    refused({"no_impact:GR1", "--vary", "delta=1%", "--within", "1"}, "'1' is no interval");
    refused({"no_impact:GR1", "--within", "0:1"}, "--vary NAME=SIZE");
    refused({"no_impact:GR1", "--vary", "delta=1%", "--data", "x"}, "--plot FILE");
}

} // namespace graze::testing::tolerance_command_test
