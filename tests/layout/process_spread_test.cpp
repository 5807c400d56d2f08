#include "graze/layout/process_spread.hpp"

#include "base/message_of.hpp"
#include "graze/layout/device_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <string>

namespace graze::process_spread_test {

using ::testing::HasSubstr;

TEST(ProcessSpread, HasTheRequestedDeviationsAndCorrelations) {
    ProcessSpread spread;
    spread.bias = {.wafer = 3, .radial = 0, .device = 4};
    spread.taper = {.wafer = 0, .radial = 8, .device = 0};
    spread.correlation = 10;
    const std::vector<SitePlace> sites{{0, 0}, {10, 0}, {0, 1000}};
    double mean = 0, square = 0, near = 0, far = 0;
    constexpr std::size_t wafers = 20000;
    for (std::size_t i = 0; i < wafers; ++i) {
        const auto departures = departures_of(spread, sites, 2000, 1, i);
        mean += departures[0].bias / wafers;
        square += departures[0].bias * departures[0].bias / wafers;
        near += departures[0].bias * departures[1].bias / wafers;
        far += departures[0].bias * departures[2].bias / wafers;
        EXPECT_DOUBLE_EQ(departures[2].taper, 8 * 0.25);
        EXPECT_EQ(departures[0].thickness, 0);
    }
    // Four standard errors of means over 20000 wafers; variances are 25, of which 9 are between wafers.
    EXPECT_NEAR(mean, 0, 4 * 5 / std::sqrt(20000.0));
    EXPECT_NEAR(square, 25, 4 * 25 * std::sqrt(2.0 / 20000));
    EXPECT_NEAR(near, 9 + 16 * std::exp(-0.5), 4 * 31 / std::sqrt(20000.0));
    EXPECT_NEAR(far, 9, 4 * 27 / std::sqrt(20000.0));
    // Draws are independent of each other.
    const auto alone = departures_of(spread, sites, 2000, 1, 7), again = departures_of(spread, sites, 2000, 1, 7);
    EXPECT_EQ(alone[1].bias, again[1].bias);
    EXPECT_NE(alone[1].bias, departures_of(spread, sites, 2000, 2, 7)[1].bias);
}

TEST(ProcessSpread, IsEqualAtCoincidentSites) {
    ProcessSpread spread;
    spread.bias.device = 1;
    spread.correlation = 1e6;
    const std::vector<SitePlace> sites(50, SitePlace{1, 2}); // a singular correlation matrix
    for (const ProcessDeparture& one : departures_of(spread, sites, 10, 1, 0)) {
        EXPECT_TRUE(std::isfinite(one.bias));
        EXPECT_NEAR(one.bias, departures_of(spread, sites, 10, 1, 0)[0].bias, 1e-6); // root of the pivots' round-off
    }
    EXPECT_THROW(departures_of(spread, std::vector<SitePlace>(3000), 10, 1, 0), InputError);
}

DeviceFile with_spread(const std::string& lines) {
    return parse_device_file("name = \"one\"\n[device]\n[spread]\n" + lines, "one.toml");
}

TEST(ProcessSpread, IsReadInAnyUnit) {
    const ProcessSpread spread = with_spread(R"(bias = { wafer = "20 nm", radial = -0.1, device = "0.01 um" }
taper = { wafer = "0.01 deg" }
correlation = "3 cm"
drive = "tuned"
)")
                                     .spread;
    EXPECT_EQ(spread.bias.wafer, 0.02);
    EXPECT_EQ(spread.bias.radial, -0.1);
    EXPECT_EQ(spread.bias.device, 0.01);
    EXPECT_EQ(spread.taper.wafer, 0.01);
    EXPECT_EQ(spread.correlation, 30'000);
    EXPECT_TRUE(spread.tuned);
    EXPECT_FALSE(spread.is_empty());
    EXPECT_TRUE(with_spread("").spread.is_empty());
}

TEST(ProcessSpread, ErrorsHavePlaceAndRemedy) {
    const std::pair<const char*, const char*> mistakes[] = {
        {"bias = { wafer = -1 }", "one.toml:4:18: spread.bias.wafer is -1 um; give a number from 0 to 1000"},
        {"bias = { wafer = nan }", "one.toml:4:18: spread.bias.wafer is not a finite number"},
        {"bias = { wafer = \"1 deg\" }", "spread.bias.wafer is not measured in deg; give it in um"},
        {"bias = 3", "one.toml:4:8: spread.bias must be a table"},
        {"bias = { wafr = 1 }", "unknown key 'wafr' in spread.bias"},
        {"drive = \"tunde\"", "one.toml:4:9: "},
        {"gap = { wafer = 1 }", "one.toml:4:1: unknown key 'gap' in spread"},
        {"correlation = inf", "one.toml:4:15: spread.correlation is not a finite number"}};
    for (const auto& [text, said] : mistakes)
        EXPECT_THAT(testing::message_of([&, &text = text] { with_spread(text); }), HasSubstr(said));
}

} // namespace graze::process_spread_test
