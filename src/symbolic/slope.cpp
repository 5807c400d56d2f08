#include "symbolic/slope.hpp"

#include "symbolic/function_table.hpp"

#include <stdexcept>

namespace graze {

namespace {

Expression square(const Expression& x) {
    return pow(x, 2);
}
Expression one_minus_square(const Expression& x) {
    return 1 - square(x);
}

} // namespace

Expression slope_of(Operation operation, const Expression& y, const Expression& a) {
    switch (operation) {
    case Operation::negate:
        return a.graph()->number(-1);
#define GRAZE_ROW(name, recurrence, slope)                                                                             \
    case Operation::name:                                                                                              \
        return slope;
        GRAZE_FUNCTIONS(GRAZE_ROW)
#undef GRAZE_ROW
    default:
        throw std::invalid_argument("an operation of one operand was expected");
    }
}

} // namespace graze
