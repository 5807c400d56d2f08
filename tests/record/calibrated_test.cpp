#include "graze/record/calibrated.hpp"

#include "graze/base/input_error.hpp"
#include "record/waves.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace graze::testing::calibrated_test {

TEST(Calibrated, ConvertsReadingsOfAPart) {
    const auto line = [](double t) { return t; };
    for (const std::size_t part : {1U, 7U, 1000U}) {
        StoredSamples source(named({"q", "v"}), sampled(10, 100, {line, line}), part);
        Calibrated calibrated(borrowed(source), {{{0, 2, 1, "mm"}}, 2.95, 5.05});
        EXPECT_EQ(calibrated.header().channels[0].unit, "mm");
        const Samples rows = read_all(calibrated, 1000);
        ASSERT_EQ(rows.rows(), 21U);
        EXPECT_EQ(rows.times.front(), 3);
        EXPECT_EQ(rows.values[0].front(), 7);
        EXPECT_EQ(rows.values[1].back(), 5);
    }
}

TEST(Calibrated, RefusesInvalidSettings) {
    StoredSamples source(named({"q"}), sampled(10, 100, {[](double) { return 1e300; }}));
    EXPECT_THROW(Calibrated(borrowed(source), {{{1, 2, 1, {}}}}), InputError);
    EXPECT_THROW(Calibrated(borrowed(source), {{{0, std::nan(""), 1, {}}}}), InputError);
    EXPECT_THROW(Calibrated(borrowed(source), {{}, 2, 1}), InputError);
    Calibrated large(borrowed(source), {{{0, 1e300, 0, {}}}});
    Samples rows;
    EXPECT_THROW(large.read(rows), InputError);
}

} // namespace graze::testing::calibrated_test
