#include "page/grazing_json.hpp"

#include "graze/results/touch_facts.hpp"
#include "page/table_json.hpp"

#include <fmt/format.h>

namespace graze {

nlohmann::json grazing_json(const ResultFile& file, const std::string& run, std::size_t number) {
    const TouchingOrbit orbit = find_touching_orbit(file, fmt::format("{}:{}", run, number), "", {}, {});
    const TouchReport report = touch_report(System(orbit.stored.run.model), orbit.map, orbit.parameter, false);
    const Table facts = touch_facts(orbit, report);
    nlohmann::json one{{"run", run}, {"number", number}, {"verdict", name_of(report.verdict.outcome)}};
    one["words"] = report.verdict.reason;
    one["facts"] = table_json("", facts)["rows"];
    for (const nlohmann::json& fact : one["facts"])
        if (fact[0] == "verdict")
            one["words"] = fact[2];
    return one;
}

} // namespace graze
