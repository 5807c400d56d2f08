#include "graze/layout/process_steps.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace graze::process_steps_test {

class ProcessSteps : public ::testing::Test {
protected:
    const DeviceFile file = load_device_file("mems-switch-device");
    const Layout layout = draw_device_layout(file);
    const double plane = plane_through_stop(layout);
    const std::vector<ProcessStep> steps = process_steps(file, layout, plane);

    double area(std::size_t step, ProcessMaterial material, double above = -1e9) const {
        double sum = 0;
        for (const ProcessSlab& slab : steps[step - 1].slabs)
            if (slab.material == material && slab.low >= above)
                sum += (slab.right - slab.left) * (slab.high - slab.low);
        return sum;
    }
    std::vector<std::pair<double, double>> stretches(std::size_t step, ProcessMaterial material, double high) const {
        std::vector<std::pair<double, double>> all;
        for (const ProcessSlab& slab : steps[step - 1].slabs)
            if (slab.material == material && std::abs(slab.high - high) < 1e-9) {
                if (!all.empty() && slab.left == all.back().second)
                    all.back().second = slab.right;
                else
                    all.emplace_back(slab.left, slab.right);
            }
        return all;
    }
};

TEST_F(ProcessSteps, FollowTheMasks) {
    ASSERT_EQ(steps.size(), 11U);
    const double thickness = file.process.wafer_thickness, depth = file.process.chamber_depth;
    const double width = file.device.die_length, whole = width * thickness;
    EXPECT_NEAR(area(1, ProcessMaterial::silicon), whole, 1e-6 * whole);
    // The plane cuts the chamber beside the channel: its whole box except the base of the electrode.
    const DeviceDrawing& drawing = layout.devices.front().drawing;
    const double chamber = static_cast<double>(drawing.chamber_box.width() - bounding_box(drawing.base).width()) / 1000;
    EXPECT_NEAR(area(3, ProcessMaterial::silicon), whole - chamber * depth, 1e-6 * whole);
    // Resist of mask 2 is exactly where silicon of the device wafer remains.
    EXPECT_EQ(stretches(8, ProcessMaterial::resist, thickness * 1.08),
              stretches(9, ProcessMaterial::silicon, thickness));
    EXPECT_EQ(stretches(9, ProcessMaterial::silicon, thickness), stretches(10, ProcessMaterial::silicon, thickness));
    EXPECT_EQ(area(10, ProcessMaterial::resist), 0);
    // The gaps between electrode and mass, and between mass and stop, are open down to the epoxy.
    const auto left = stretches(10, ProcessMaterial::silicon, thickness);
    const double gap = file.device.gap, stop_gap = file.device.stop_gap;
    bool has_gap = false, has_stop_gap = false;
    for (std::size_t i = 1; i < left.size(); ++i) {
        has_gap = has_gap || std::abs(left[i].first - left[i - 1].second - gap) < 1e-9;
        has_stop_gap = has_stop_gap || std::abs(left[i].first - left[i - 1].second - stop_gap) < 1e-9;
    }
    EXPECT_TRUE(has_gap);
    EXPECT_TRUE(has_stop_gap);
}

TEST_F(ProcessSteps, KeepMarksUntilTheSecondMaskIsAligned) {
    for (std::size_t step = 1; step <= 10; ++step)
        EXPECT_EQ(area(step, ProcessMaterial::aluminium) > 0, step == 5 || step == 7) << step;
    EXPECT_GT(area(11, ProcessMaterial::aluminium), 0);
    for (std::size_t step = 1; step <= 11; ++step)
        EXPECT_EQ(area(step, ProcessMaterial::epoxy) > 0, step >= 6) << step;
}

TEST_F(ProcessSteps, CoatNothingBelowAnOverhang) {
    // Metal covers the epoxy where silicon was etched away, so it does not reach below the electrode to its base.
    const double thickness = file.process.wafer_thickness;
    const auto silicon = stretches(10, ProcessMaterial::silicon, thickness);
    for (const ProcessSlab& slab : steps[10].slabs)
        if (slab.material == ProcessMaterial::aluminium && slab.low == 0 && slab.high < thickness) {
            for (const auto& [left, right] : silicon)
                EXPECT_TRUE(slab.right <= left + 1e-9 || slab.left >= right - 1e-9);
        }
}

} // namespace graze::process_steps_test
