#pragma once

#include "graze/model/model_file.hpp"
#include "graze/results/result_file.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <string>
#include <tuple>
#include <vector>

namespace graze::testing {

/// A run of a model without any results, whose coordinates are all parameters.
inline RunRecord run_of(const Model& model, const std::string& name, const std::string& kind) {
    RunRecord run;
    run.name = name;
    run.kind = kind;
    run.model_name = model.name;
    run.model = write_model(model);
    for (const auto& symbol : model.parameter_symbols())
        run.coordinates.push_back({symbol.name(), ""});
    for (const State& state : model.states)
        run.states.push_back({state.name, ""});
    for (const Mode& mode : model.modes)
        run.modes.push_back(mode.name);
    run.directions = {""};
    return run;
}

/// Numbers of the minima and end values of an orbit.
inline std::vector<std::tuple<bool, std::size_t, std::size_t, double, double, double>>
details_of(const SpecialPoint& point) {
    std::vector<std::tuple<bool, std::size_t, std::size_t, double, double, double>> rows;
    for (const OrbitMinimum& one : point.solution.certificate.minima)
        rows.emplace_back(true, one.segment, one.event, one.time, one.value, one.size);
    for (const EndValue& one : point.solution.certificate.end_values)
        rows.emplace_back(false, one.segment, one.event, one.value, one.rate, 0);
    return rows;
}

/// All that is stored of an orbit, but what is told of its touch.
inline auto contents_of(const OrbitRecord& record) {
    const SpecialPoint& p = record.point;
    const Orbit& orbit = p.solution.orbit;
    return std::tuple(record.label, record.stable, p.type, p.detail, p.parameter, p.tangent, p.monitors,
                      p.solution.multipliers, p.solution.half_multipliers, orbit.signature, orbit.parameters,
                      orbit.starts, orbit.durations, p.solution.certificate.approach_speeds,
                      p.solution.certificate.admissible, details_of(p));
}

/// Changes a file by statements of another program.
inline void change(const std::string& path, const std::string& sql) {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
    char* message = nullptr;
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, &message), SQLITE_OK) << message << ": " << sql;
    sqlite3_close(database);
}

} // namespace graze::testing
