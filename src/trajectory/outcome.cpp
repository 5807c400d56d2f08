#include "graze/trajectory/outcome.hpp"

#include "base/enumerator_name.hpp"

namespace graze {

std::string_view name_of(Ending ending) {
    constexpr std::string_view names[] = {"running",     "end-time",     "stopped",       "terminal", "singular",
                                          "undefined",   "inadmissible", "no-transition", "chatter",  "no-separation",
                                          "no-progress", "step-limit",   "two-fold",      "painleve"};
    return enumerator_name(names, ending, "unknown");
}

bool is_regular(Ending ending) {
    return ending == Ending::end_time || ending == Ending::stopped || ending == Ending::terminal ||
           ending == Ending::singular;
}

} // namespace graze
