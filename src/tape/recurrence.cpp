#include "tape/recurrence.hpp"

#include "symbolic/function_table.hpp"

namespace graze {

Recurrence recurrence_of(SeriesOperation operation) {
    switch (operation) {
#define GRAZE_ROW(name, recurrence, slope)                                                                             \
    case SeriesOperation::name:                                                                                        \
        return Recurrence::recurrence;
        GRAZE_FUNCTIONS(GRAZE_ROW)
#undef GRAZE_ROW
    default:
        return Recurrence::own;
    }
}

} // namespace graze
