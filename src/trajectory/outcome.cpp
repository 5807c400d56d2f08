#include "graze/trajectory/outcome.hpp"

namespace graze {

std::string_view name_of(Ending ending) {
    switch (ending) {
    case Ending::running:
        return "running";
    case Ending::end_time:
        return "end-time";
    case Ending::stopped:
        return "stopped";
    case Ending::terminal:
        return "terminal";
    case Ending::singular:
        return "singular";
    case Ending::undefined:
        return "undefined";
    case Ending::inadmissible:
        return "inadmissible";
    case Ending::no_transition:
        return "no-transition";
    case Ending::chatter:
        return "chatter";
    case Ending::no_separation:
        return "no-separation";
    case Ending::no_progress:
        return "no-progress";
    case Ending::step_limit:
        return "step-limit";
    }
    return "unknown";
}

bool is_regular(Ending ending) {
    return ending == Ending::end_time || ending == Ending::stopped || ending == Ending::terminal ||
           ending == Ending::singular;
}

} // namespace graze
