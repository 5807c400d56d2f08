#pragma once

#include <string>
#include <string_view>

namespace graze {

/// How a trajectory ended, or `running`.
enum class Ending {
    running,
    end_time,      ///< the requested end time is reached
    stopped,       ///< the observer asked to stop (a count of periods, events, ... is reached)
    terminal,      ///< a transition whose next mode is "end"
    singular,      ///< the solution ceases to exist at a finite time, as when a gap closes by snap-through
    undefined,     ///< the vector field has no finite value at the present state
    inadmissible,  ///< a barrier is violated at the start or after a jump
    no_transition, ///< no alternative's conditions hold after an event
    chatter,       ///< contacts accumulate and no sticking mode is declared
    no_separation, ///< after its jump, a barrier is still being approached
    no_progress,   ///< too many events at one time
    step_limit,    ///< more steps than allowed
    two_fold,      ///< sliding ends towards both sides at once: the motion beyond is not unique
    painleve,      ///< no contact forces with friction are consistent, or several are (Painlevé's paradox)
};

/// Stable name for tables and files, such as "end-time".
std::string_view name_of(Ending ending);
/// Returns true for ends that the user requested or that belong to the system (end_time, stopped, terminal, singular);
/// the others call for a change of the model or of the options.
bool is_regular(Ending ending);

struct Outcome {
    Ending ending = Ending::running;
    double time = 0;    ///< end time; for `singular`, the time of the singularity
    std::string detail; ///< one line: what happened and what to do; empty for regular ends
};

} // namespace graze
