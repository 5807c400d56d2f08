// A project that uses an installed graze: counts the impacts of a shipped model.

#include <graze/model/catalogue.hpp>
#include <graze/trajectory/trajectory.hpp>

#include <cstdio>

struct Counter : graze::Observer {
    int impacts = 0;
    void contact(const graze::Contact& contact) override {
        impacts += contact.kind == graze::ContactKind::crossing ? 1 : 0;
    }
};

int main() {
    const graze::Model model = graze::load_model("bouncing-ball");
    const graze::Simulation simulation{graze::System(model)};
    Counter counter;
    graze::Trajectory trajectory(simulation, model.parameter_values(), borrowed(counter));
    trajectory.start(model.initial_state(), model.initial_mode, 0, 10);
    graze::JetSet jets(simulation, graze::LaneKind::single);
    run(trajectory, jets);
    std::printf("%d contacts up to t = %g\n", counter.impacts, trajectory.time());
    return counter.impacts > 0 ? 0 : 1;
}
