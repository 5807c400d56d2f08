#include "graze/trajectory/outcome.hpp"

#include <cstddef>
#include <iterator>

namespace graze {

std::string_view name_of(Ending ending) {
    constexpr std::string_view names[] = {"running",  "end-time",      "stopped",      "terminal",
                                          "singular", "undefined",     "inadmissible", "no-transition",
                                          "chatter",  "no-separation", "no-progress",  "step-limit"};
    const auto place = static_cast<std::size_t>(ending);
    return place < std::size(names) ? names[place] : "unknown";
}

bool is_regular(Ending ending) {
    return ending == Ending::end_time || ending == Ending::stopped || ending == Ending::terminal ||
           ending == Ending::singular;
}

} // namespace graze
