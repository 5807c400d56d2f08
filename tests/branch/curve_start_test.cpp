// Which curves of special points begin at a point, and the messages where none does.

#include "graze/branch/curve_start.hpp"

#include "graze/base/input_error.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <utility>
#include <vector>

namespace graze::curve_start_test {

SpecialPoint with_multipliers(PointType type, std::vector<std::complex<double>> multipliers) {
    SpecialPoint point;
    point.type = type;
    point.solution.multipliers = std::move(multipliers);
    return point;
}

TEST(CurveStart, CurvesAtAPointFollowFromItsMultipliersAndTouches) {
    using enum PointType;
    const auto curves = [](const SpecialPoint& point) { return curves_at(point); };
    const std::complex<double> turn = std::polar(1.0, 0.9);
    EXPECT_EQ(curves(with_multipliers(fold, {1, 0.2})), std::vector{fold});
    EXPECT_EQ(curves(with_multipliers(fold_flip, {1, -1})), (std::vector{fold, flip}));
    EXPECT_EQ(curves(with_multipliers(fold_torus, {1, turn, std::conj(turn)})), (std::vector{fold, torus}));
    EXPECT_EQ(curves(with_multipliers(flip_torus, {-1, turn, std::conj(turn)})), (std::vector{flip, torus}));
    EXPECT_EQ(curves(with_multipliers(resonance_1, {{1, 1e-7}, {1, -1e-7}})), (std::vector{fold, torus}));
    EXPECT_EQ(curves(with_multipliers(resonance_2, {-1.0000001, -0.9999999})), (std::vector{flip, torus}));
    EXPECT_EQ(curves(with_multipliers(resonance_3, {std::polar(1.0, 2.0943951), std::polar(1.0, -2.0943951)})),
              std::vector{torus});
    EXPECT_EQ(curves(with_multipliers(regular, {0.5, 0.2})), std::vector<PointType>{});
    SpecialPoint half = with_multipliers(asymmetry, {1, 0.04});
    half.solution.half_multipliers = {-1, 0.2};
    half.solution.orbit.symmetry = 0;
    EXPECT_EQ(curves(half), std::vector{asymmetry});
    // Touches are read from the certificate.
    SpecialPoint touch = with_multipliers(fold, {1, 0.2});
    touch.solution.certificate.minima = {{0, 3, 0.5, 0.1, 1}, {2, 1, 0.25, 1e-13, 1}};
    EXPECT_EQ(curves(touch), (std::vector{fold, grazing}));
    const SpecialPoint as_touch = as_type(touch, grazing);
    EXPECT_EQ(as_touch.type, grazing);
    EXPECT_EQ(as_touch.segment, 2U);
    EXPECT_EQ(as_touch.event, 1U);
    EXPECT_EQ(as_touch.time, 0.25);
}

TEST(CurveStart, WrongTypesAreRefusedWithTheMultipliers) {
    try {
        as_type(with_multipliers(PointType::resonance_1, {1, 1}), PointType::flip);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.problem(), "the point of type R1 (1:1 resonance) is no flip: its multipliers are 1, 1");
        EXPECT_EQ(error.remedy(), "curves that begin there are \"SN\", \"NS\"");
    }
    EXPECT_THROW(as_type(with_multipliers(PointType::bound, {0.5}), PointType::fold), InputError);
    EXPECT_THROW(as_type(with_multipliers(PointType::grazing, {}), PointType::fold), InputError);
    EXPECT_THROW(as_type(with_multipliers(PointType::fold, {1}), PointType::vanishing), InputError);
}

} // namespace graze::curve_start_test
