#include "trajectory/stoppable_run.hpp"
#include "graze/base/input_error.hpp"


namespace graze {

bool run_until(Trajectory& trajectory, JetSet& jets, const std::function<bool()>& stopped) {
    if (!(trajectory.simulation() == jets.simulation()))
        throw InputError("a trajectory of one simulation cannot run on the jets of another", "");
    if (jets.width() != 1)
        throw InputError("one trajectory cannot run on jets of several lanes", "");
    if (!trajectory.is_started())
        throw OrderError("a trajectory has to be started before it can run");
    if (!trajectory.tangents().empty())
        jets.add_tangents();
    jets.set_parameters(trajectory.parameters());
    Outlook outlook(trajectory.simulation(), 1);
    while (!trajectory.finished()) {
        Jet& jet = jets.computed(trajectory.mode(), trajectory.state());
        outlook.lengths()[0] = trajectory.previous_step();
        outlook.find_steps(jet);
        outlook.lengths()[0] = trajectory.propose(jet, outlook.length(0));
        outlook.look(jet, jets.next(trajectory.mode()), trajectory.mode());
        trajectory.advance(outlook);
        if (stopped && stopped())
            break;
    }
    return trajectory.finished();
}

void run(Trajectory& trajectory, JetSet& jets) {
    run_until(trajectory, jets, nullptr);
}

} // namespace graze
