// Many trajectories at once, in SIMD lanes: how the number of impacts depends on the voltage of the testbed.

#include <graze/model/catalogue.hpp>
#include <graze/trajectory/ensemble.hpp>

#include <cstdio>
#include <vector>

using namespace graze;

struct Counter : Observer {
    int impacts = 0;
    void contact(const Contact& contact) override { impacts += contact.kind == ContactKind::crossing ? 1 : 0; }
};

int main() {
    Model model = load_model("electromagnetic-testbed");
    const Simulation simulation{System(model)};
    constexpr int count = 16;
    std::vector<Counter> counters(count);
    std::vector<Trajectory> trajectories;
    for (int i = 0; i < count; ++i) {
        model.set_parameter("V0", 4.6 + 0.05 * i);
        trajectories.emplace_back(simulation, model.parameter_values(),
                                  borrowed(counters[static_cast<std::size_t>(i)]));
        trajectories.back().start(model.initial_state(), model.initial_mode, 0, 16);
    }
    Ensemble ensemble(simulation);
    ensemble.run(trajectories);
    for (int i = 0; i < count; ++i)
        std::printf("%.2f V: %d impacts in 100 periods\n", 4.6 + 0.05 * i,
                    counters[static_cast<std::size_t>(i)].impacts);
    return 0;
}
