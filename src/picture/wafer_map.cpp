#include "graze/picture/wafer_map.hpp"

#include "picture/gnuplot_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace graze {

namespace {

constexpr double pitch = 2.25;     // distance of the centres of wafers, in radii
constexpr double wafer_size = 240; // pixels

class WaferMap {
public:
    WaferMap(const WaferYield& yield, const WaferPlan& plan, const WaferMapLabels& labels)
        : yield_(&yield), plan_(&plan), labels_(&labels) {
        for (const WaferDevice& device : yield.devices)
            wafers_ = std::max(wafers_, std::min(device.wafer, most_wafers_drawn));
        columns_ = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(wafers_))));
        rows_ = (wafers_ + columns_ - 1) / columns_;
    }

    std::string text(const std::string& ending, const std::string& output) {
        add_devices();
        std::string blocks, plots = "plot $outlines with lines lc rgb '#666666'";
        const auto add = [&](const char* name, const std::string& data, const char* style) {
            blocks += fmt::format("${} << EOD\n{}EOD\n", name, data);
            plots += data.empty() ? "" : fmt::format(", ${} {}", name, style);
        };
        add("found", found_, "using 1:2:3 with points pt 7 ps 2 lc palette");
        add("rings", rings_, "with points pt 6 ps 2.6 lw 1.5 lc rgb '#000000'");
        add("crosses", crosses_, "with points pt 2 ps 1.5 lw 2 lc rgb '#000000'");
        return head(ending, output) + outlines() + blocks + labels_of_devices_ + plots + "\nset output\n";
    }

private:
    /// Centre of a wafer, in radii.
    std::pair<double, double> middle(std::size_t wafer) const {
        const std::size_t column = (wafer - 1) % columns_, row = (wafer - 1) / columns_;
        return {pitch * static_cast<double>(column), -pitch * static_cast<double>(row)};
    }

    std::string head(const std::string& ending, const std::string& output) const {
        const double width = wafer_size * static_cast<double>(columns_) + 160,
                     height = wafer_size * static_cast<double>(rows_) + 60;
        const char* font = ending == "png" || ending == "pdf" ? " font 'sans,11'" : " font 'sans,13'";
        const std::string terminal = drawing_terminal(ending, width, height) + font;
        const double right = pitch * static_cast<double>(columns_ - 1) + 1.12,
                     low = -pitch * static_cast<double>(rows_ - 1) - 1.12;
        return fmt::format(
            "set terminal {}\nset output {}\nset encoding utf8\nunset key\nunset tics\nunset border\n"
            "set title \"{}\"\nset size ratio -1\nset lmargin 1\nset xrange [-1.12:{:.6g}]\n"
            "set yrange [{:.6g}:1.12]\nset cbtics\nset colorbox\nset cblabel \"{}{}\"\n"
            "set palette defined (0 '#0d0887', 0.25 '#7e03a8', 0.5 '#cc4778', 0.75 '#f89540', 1 '#f0f921')\n",
            terminal, quoted_path(output), plain(labels_->title), right, low, plain(labels_->control),
            labels_->unit.empty() ? "" : " (" + plain(labels_->unit) + ")");
    }

    /// Outlines of the wafers, each with its flat at the bottom.
    std::string outlines() const {
        const double half = std::clamp(plan_->flat_length / plan_->diameter, 0.0, 1.0);
        const double from = std::numbers::pi * 1.5 + std::asin(half), turn = 2 * std::numbers::pi - 2 * std::asin(half);
        std::string data = "$outlines << EOD\n", labels;
        for (std::size_t wafer = 1; wafer <= wafers_; ++wafer) {
            const auto [x, y] = middle(wafer);
            constexpr int corners = 180;
            for (int i = 0; i <= corners + 1; ++i) { // the last point closes the outline along the flat
                const double angle = from + turn * (i % (corners + 1)) / corners;
                data += fmt::format("{:.6g} {:.6g}\n", x + std::cos(angle), y + std::sin(angle));
            }
            data += "\n";
            labels += fmt::format("set label \"wafer {}\" at {:.6g},{:.6g} center front\n", wafer, x, y);
        }
        return data + "EOD\n" + labels;
    }

    bool is_within(double value) const {
        return (labels_->least || labels_->greatest) && (!labels_->least || value >= *labels_->least) &&
               (!labels_->greatest || value <= *labels_->greatest);
    }

    /// Number of decimals of all values, so that the greatest has four digits.
    int decimals() const {
        double greatest = 0;
        for (const WaferDevice& device : yield_->devices)
            if (device.outcome == DeviceOutcome::found)
                greatest = std::max(greatest, std::abs(device.value));
        return greatest > 0 ? std::clamp(3 - static_cast<int>(std::floor(std::log10(greatest))), 0, 9) : 0;
    }

    void add_devices() {
        for (const WaferDevice& device : yield_->devices) {
            if (device.wafer > wafers_)
                continue;
            const auto [x, y] = middle(device.wafer);
            const double dx = 2 * device.place.x / plan_->diameter, dy = 2 * device.place.y / plan_->diameter;
            const std::string at = fmt::format("{:.6g} {:.6g}", x + dx, y + dy);
            if (device.outcome != DeviceOutcome::found) {
                crosses_ += at + "\n";
                continue;
            }
            found_ += fmt::format("{} {:.17g}\n", at, device.value);
            if (is_within(device.value))
                rings_ += at + "\n";
            // The value is written towards the centre for devices at the sides, and beyond devices above and below:
            // eight devices fit so.
            constexpr std::size_t few = 12; // greatest number of devices on a wafer with labels
            const bool aside = std::abs(dx) > std::abs(dy);
            const double farther = aside ? 1 : 1.36, beside = aside ? std::copysign(0.09, -dx) : 0;
            if (plan_->devices <= few)
                labels_of_devices_ += fmt::format("set label \"{:.{}f}\" at {:.6g},{:.6g} {} front font ',9'\n",
                                                  device.value, decimals(), x + farther * dx + beside, y + farther * dy,
                                                  !aside   ? "center"
                                                  : dx < 0 ? "left"
                                                           : "right");
        }
    }

    const WaferYield* yield_;
    const WaferPlan* plan_;
    const WaferMapLabels* labels_;
    std::size_t wafers_ = 1, columns_ = 1, rows_ = 1;
    std::string found_, rings_, crosses_, labels_of_devices_; ///< lines for gnuplot
};

} // namespace

std::string wafer_map_script(const WaferYield& yield, const WaferPlan& plan, const WaferMapLabels& labels,
                             const std::string& ending, const std::string& output) {
    return WaferMap(yield, plan, labels).text(ending, output);
}

} // namespace graze
