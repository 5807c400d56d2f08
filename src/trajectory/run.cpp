#include "graze/base/input_error.hpp"
#include "trajectory/stoppable_run.hpp"

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
    StepPreview preview(trajectory.simulation(), 1);
    while (!trajectory.finished()) {
        Jet& jet = jets.computed(trajectory.mode(), trajectory.state());
        preview.lengths()[0] = trajectory.previous_step();
        preview.find_steps(jet);
        preview.lengths()[0] = trajectory.propose(jet, preview.length(0));
        preview.evaluate_ends(jet, jets.next(trajectory.mode()), trajectory.mode());
        trajectory.advance(preview);
        if (stopped && stopped())
            break;
    }
    return trajectory.finished();
}

void run(Trajectory& trajectory, JetSet& jets) {
    run_until(trajectory, jets, nullptr);
}

} // namespace graze
