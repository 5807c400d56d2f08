// Will it trip? A ball rests in front of a shaker whose amplitude just reaches it.

#include <graze/grazing/trial.hpp>
#include <graze/model/catalogue.hpp>
#include <graze/orbit/solve.hpp>

#include <cmath>
#include <cstdio>

using namespace graze;

int main() {
    for (const double frequency : {6, 10, 14, 18, 22}) {
        Model model = load_model("ball-and-shaker");
        model.set_parameter("f", frequency);
        model.set_parameter("a", 0.65);
        model.set_parameter("b", 0.65);
        const System system(model);

        // The ball at rest for one period of the shaker, from one passage of a section to the next.
        Orbit resting;
        resting.signature = parse_signature(model, "free:phase0");
        resting.parameters = model.parameter_values();
        resting.starts = {{0, 0, 0}};
        resting.durations = {1 / frequency};

        CycleMapOptions options;
        options.parameter = model.independent_parameter("a");
        const OrbitTouch touch = touches_of(system, resting, options).front();
        const CycleMap map = cycle_map(system, resting, touch, options);
        const Verdict verdict = verdict_of(map);
        const Trial trial = try_verdict(system, map, verdict, *options.parameter);
        std::printf("%2.0f Hz: %s, n = %zu, log10 c = %.11f; simulation: %s\n", frequency,
                    name_of(verdict.outcome).data(), verdict.next_contact, std::log10(*verdict.jump_growth),
                    name_of(trial.outcome).data());
    }
    return 0;
}
