#include "page/special_points_json.hpp"

#include "graze/results/stored_orbit.hpp"
#include "page/json_text.hpp"
#include "page/orbit_facts.hpp"
#include "page/quantity_json.hpp"
#include "picture/shown_names.hpp"

namespace graze {

nlohmann::json special_points_json(const StoredRun& run) {
    nlohmann::json columns = nlohmann::json::array(), rows = nlohmann::json::array();
    for (const auto* list : {&run.record.coordinates, &run.record.values})
        for (const ResultColumn& column : *list)
            columns.push_back(quantity_json(column.name, column.unit, words_of(run, column.name)));
    if (run.record.is_branch())
        for (const OrbitRecord& record : run.file.orbits(run.record.name, true)) {
            nlohmann::json row = orbit_facts(run.record, record);
            std::vector<double> values = parameters_of(run, record);
            const std::vector<double>& monitors = record.point.monitors;
            values.insert(values.end(), monitors.begin(), monitors.end());
            row["coordinates"] = numbers_json(values);
            rows.push_back(std::move(row));
        }
    nlohmann::json one{{"run", run.record.name}};
    one["columns"] = std::move(columns);
    one["rows"] = std::move(rows);
    return one;
}

nlohmann::json special_points_json(const ResultFile& file, const std::string& run) {
    return special_points_json(StoredRun(file, run, {}));
}

} // namespace graze
