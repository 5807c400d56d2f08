#include "graze/base/physical_unit.hpp"

#include "graze/base/input_error.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace graze::physical_unit_test {

double in(double value, const char* from, const char* to) {
    return converted(value, physical_unit(from), physical_unit(to));
}

TEST(PhysicalUnit, ConvertsWithOneRounding) {
    EXPECT_EQ(in(14.6e-9, "kg", "ug"), 14.6);
    EXPECT_EQ(in(250000, "um^2", "m^2"), 2.5e-7);
    EXPECT_EQ(in(0.3, "um", "m"), 0.3e-6);
    EXPECT_EQ(in(1, "N/m", "kg/s^2"), 1);
    EXPECT_EQ(in(2330, "kg/m^3", "g/cm^3"), 2.33);
    EXPECT_EQ(in(1, "F V", "A s"), 1);
    EXPECT_EQ(in(1, "kHz", "1/ms"), 1);
    EXPECT_EQ(in(1, "Pa s", "N s/m^2"), 1);
    EXPECT_EQ(in(1, "GPa", "N/um^2"), 1e-3);
    EXPECT_EQ(in(1, "μm", "µm"), 1);
    EXPECT_EQ(in(3, "rad/ms", "1/s"), 3000);
    EXPECT_EQ(in(1, "Mm", "nm"), 1e15); // from nano to mega
    EXPECT_EQ(physical_unit(""), PhysicalUnit());
}

TEST(PhysicalUnit, ReadsMinutesHoursAndWords) {
    EXPECT_EQ(in(3, "min", "s"), 180);
    EXPECT_EQ(in(1.5, "h", "min"), 90);
    EXPECT_DOUBLE_EQ(in(3000, "rad/min", "rad/s"), 50);
    EXPECT_DOUBLE_EQ(in(7200, "m/h^2", "m/min/h"), 120);
    EXPECT_FALSE(known_unit("mh")); // hours take no prefixes
    for (const auto& [word, symbol] :
         {std::pair{"seconds", "s"}, std::pair{"sec", "s"}, std::pair{"msec", "ms"}, std::pair{"mSec", "ms"},
          std::pair{"usec", "us"}, std::pair{"milliseconds", "ms"}, std::pair{"Minutes", "min"}, std::pair{"hrs", "h"},
          std::pair{"Volts", "V"}, std::pair{"mVolt", "mV"}, std::pair{"kOhm", "kohm"}, std::pair{"kΩ", "kohm"}}) {
        EXPECT_EQ(unit_symbol(word), symbol);
        EXPECT_EQ(known_unit(word), physical_unit(symbol)) << word;
    }
    for (const char* symbol : {"s", "S", "mS", "MSec", "V", "m/s", "min", "dBV", "", "kmin"})
        EXPECT_EQ(unit_symbol(symbol), symbol) << symbol;
    EXPECT_EQ(in(1, "mS", "1/ohm"), 1e-3); // mS is millisiemens, not a time
    EXPECT_DOUBLE_EQ(in(1, "V msec/A", "H"), 1e-3);
    EXPECT_FALSE(known_unit("MSec")) << "ambiguous: it may mean ms";
}

TEST(PhysicalUnit, RefusesTextsThatAreNotUnits) {
    for (const char* wrong : {"inch", "um^", "um^x", "um^99", "xm", "um^1.5", "kk", "(m)"}) {
        EXPECT_THROW(physical_unit(wrong), InputError) << wrong;
        EXPECT_FALSE(known_unit(wrong)) << wrong;
    }
    EXPECT_EQ(known_unit("um"), physical_unit("um"));
    EXPECT_THROW(in(1, "um", "um^2"), InputError);
    EXPECT_THROW(in(1, "deg", "rad"), InputError); // the factor is not a power of ten
}

} // namespace graze::physical_unit_test
