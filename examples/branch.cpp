// Periodic orbits of an impact oscillator: from a motion without impacts to where it grazes the stop, and on with one.

#include <graze/branch/switching.hpp>
#include <graze/model/catalogue.hpp>

#include <cstdio>

using namespace graze;

int main() {
    Model model = load_model("impact-oscillator");
    model.set_parameter("sigma", 0.5);
    model.set_parameter("omega", 1.2);
    model.set_parameter("amplitude", 0.1);

    AttractorOptions settle;
    settle.section = "phase0";
    const System system(model); // compiled once for all that follows
    const OrbitSolution orbit = find_orbit(system, settle);

    BranchSettings settings;
    settings.parameter = model.independent_parameter("amplitude");
    settings.greatest = 1;
    const Branch free = follow_branch(system, orbit.orbit, settings);
    const SpecialPoint& grazing = free.special.back();
    std::printf("%s at amplitude %.12f\n", name_of(grazing.type).data(), grazing.parameter);

    // OrbitBranch is an iterator: it can be stopped and examined after every step.
    const BranchStart start = branches_at(system, grazing, settings).front();
    OrbitBranch branch(system, start.orbit, settings);
    for (bool going = branch.start_along(start.direction, start.distance); going; going = branch.step())
        for (const SpecialPoint& special : branch.found())
            std::printf("%s %s: amplitude %.12f, %s\n", start.how.c_str(), short_name(special.type).data(),
                        special.parameter, is_stable(branch.point().solution) ? "stable beyond" : "not stable beyond");
    std::printf("%s\n", name_of(branch.outcome()).data());
    return 0;
}
