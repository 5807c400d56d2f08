#include "graze/layout/alignment_mark.hpp"

#include "graze/base/input_error.hpp"

namespace graze {

LayoutCell alignment_mark(const std::string& name, std::int64_t size) {
    if (size < least_mark)
        throw InputError("an alignment mark is too small to be drawn", "make it at least 20 nm");
    const std::int64_t low = -(size / 2), high = low + size;
    const std::int64_t arm = size / 5, arm_low = -(arm / 2), arm_high = arm_low + arm, apart = size / 20;
    LayoutCell cell{.name = name};
    cell.add(mask_layers::back_marks, GridPolygon{{arm_low, low},
                                                  {arm_high, low},
                                                  {arm_high, arm_low},
                                                  {high, arm_low},
                                                  {high, arm_high},
                                                  {arm_high, arm_high},
                                                  {arm_high, high},
                                                  {arm_low, high},
                                                  {arm_low, arm_high},
                                                  {low, arm_high},
                                                  {low, arm_low},
                                                  {arm_low, arm_low}});
    const std::int64_t from = arm_high + apart, to = arm_low - apart;
    cell.add_all(mask_layers::front_marks,
                 std::vector<GridBox>{
                     {from, from, high, high}, {low, from, to, high}, {low, low, to, to}, {from, low, high, to}});
    return cell;
}

} // namespace graze
