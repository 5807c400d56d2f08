#include "page/point_json.hpp"

#include "graze/orbit/signature.hpp"
#include "graze/results/model_table.hpp"
#include "graze/results/orbit_table.hpp"
#include "graze/results/result_table.hpp"
#include "graze/results/run_kind.hpp"
#include "graze/results/stored_orbit.hpp"
#include "page/json_text.hpp"
#include "page/orbit_facts.hpp"
#include "page/quantity_json.hpp"
#include "page/stored_point.hpp"
#include "page/table_json.hpp"
#include "picture/shown_names.hpp"

#include <fmt/format.h>

#include <complex>
#include <vector>

namespace graze {

namespace {

constexpr std::size_t most_samples = 5000;

nlohmann::json multipliers_json(const std::vector<std::complex<double>>& multipliers) {
    nlohmann::json list = nlohmann::json::array();
    for (const std::complex<double>& one : multipliers)
        list.push_back(nlohmann::json::array({number_json(one.real()), number_json(one.imag())}));
    return list;
}

/// Columns of a run with their values at a point. @param values may be fewer
nlohmann::json valued_json(const StoredRun& run, const std::vector<ResultColumn>& columns,
                           const std::vector<double>& values) {
    nlohmann::json list = nlohmann::json::array();
    for (std::size_t i = 0; i < std::min(columns.size(), values.size()); ++i)
        list.push_back(quantity_json(columns[i].name, columns[i].unit, words_of(run, columns[i].name), values[i]));
    return list;
}

/// What is shown of a point in words.
class PointFacts {
public:
    void add(const std::string& name, std::string_view text) {
        if (!text.empty())
            list_.push_back({name, text});
    }
    void add(const std::string& name, double number, const std::string& unit = "") {
        add(name, fmt::format("{:.6g}{}{}", number, unit.empty() ? "" : " ", unit));
    }
    nlohmann::json take() { return std::move(list_); }

private:
    nlohmann::json list_ = nlohmann::json::array();
};

nlohmann::json orbit_json(const StoredRun& run, const OrbitRecord& record) {
    const OrbitSolution& solution = record.point.solution;
    const Orbit& orbit = solution.orbit;
    const Model model = model_at(run.model, orbit);
    nlohmann::json one = orbit_facts(run.record, record);
    const std::string shown = run.record.point_name(record.label);
    one["kind"] = "orbit";
    one["title"] = shown.empty() ? title_of(record) : shown;
    const bool rests = is_rest(orbit.signature);
    one["period"] = rests ? nlohmann::json() : number_json(orbit.period());
    one["error"] = solution.error ? number_json(*solution.error) : nlohmann::json();
    one["coordinates"] = valued_json(run, run.record.coordinates, parameters_of(run, record));
    one["parameters"] = parameters_json(model);
    one["values"] = valued_json(run, run.record.values, record.point.monitors);
    one["multipliers"] = multipliers_json(solution.multipliers);
    one["half_multipliers"] = multipliers_json(solution.half_multipliers);
    one["eigenvalues"] = multipliers_json(solution.eigenvalues);
    one["signature"] = to_string(model, orbit.signature);
    one["tables"] = {table_json("segments", segment_table(model, solution)),
                     table_json("minima of events", minimum_table(model, solution)),
                     table_json("events at ends of segments", end_value_table(model, solution))};
    PointFacts facts;
    if (!rests)
        facts.add("period", orbit.period(), model.time_unit);
    facts.add("solution", name_of(solution.outcome));
    facts.add("residual", solution.residual);
    if (solution.error)
        facts.add("error", *solution.error);
    if (solution.other_multipliers > 0)
        facts.add("multipliers", multipliers_text(solution, 6));
    facts.add("symmetry", orbit.symmetry ? model.symmetries.at(*orbit.symmetry).name : "");
    facts.add("not admissible", solution.certificate.reason);
    facts.add("detail", record.point.detail);
    facts.add("note", solution.detail);
    if (record.touch) {
        facts.add("verdict", record.touch->verdict);
        facts.add("reason", record.touch->reason);
    }
    one["facts"] = facts.take();
    return one;
}

/// What points that are no orbits of a branch have in common.
nlohmann::json plain_point_json(const StoredRun& run, const PointRecord& point) {
    nlohmann::json one{{"number", point.number},
                       {"label", ""},
                       {"name", ""},
                       {"title", fmt::format("point {}", point.number)},
                       {"type", ""},
                       {"type_words", ""},
                       {"detail", point.result.outcome.detail},
                       {"part", name_at(run.record.directions, point.direction)},
                       {"located", true},
                       {"stable", true},
                       {"unphysical", false},
                       {"period", nullptr},
                       {"error", nullptr},
                       {"signature", point.result.signature}};
    one["coordinates"] = valued_json(run, run.record.coordinates, point.coordinates);
    for (const char* list : {"parameters", "values", "half_multipliers", "tables", "facts"})
        one[list] = nlohmann::json::array();
    one["eigenvalues"] = multipliers_json(point.result.eigenvalues);
    one["multipliers"] = multipliers_json(point.result.multipliers);
    return one;
}

/// Whether it is known what a motion does in the end.
bool has_settled(Label label) {
    return label == Label::periodic || label == Label::quasi_periodic || label == Label::chaotic ||
           label == Label::equilibrium;
}

/// How a motion ended, where that was not asked for.
std::string_view early_ending(Ending ending) {
    return ending == Ending::stopped || ending == Ending::end_time ? "" : name_of(ending);
}

Table sample_table(const StoredRun& run, const SampleSet& samples) {
    std::vector<Table::Column> columns{{"sampling", ""}, {"t", run.model.time_unit}};
    for (const ResultColumn& value : run.record.values)
        columns.push_back({value.name, value.unit});
    Table table(std::move(columns));
    for (std::size_t s = 0; s < std::min(samples.size(), most_samples); ++s) {
        table.add(name_at(run.record.samplings, samples.samplings[s]), samples.times[s]);
        for (std::size_t v = 0; v < samples.width; ++v)
            table.add(samples.values[s * samples.width + v]);
    }
    return table;
}

void add_samples(nlohmann::json& one, const StoredRun& run, const SampleSet& samples) {
    nlohmann::json table = table_json("samples", sample_table(run, samples));
    table["left_out"] = samples.size() > most_samples;
    one["tables"].push_back(std::move(table));
}

nlohmann::json motion_point_json(const StoredRun& run, const PointRecord& point) {
    const PointResult& result = point.result;
    const std::string label(name_of(result.label)), time_unit = run.model.time_unit;
    nlohmann::json one = plain_point_json(run, point);
    one["kind"] = "motion";
    one["type"] = label;
    one["type_words"] = result.label == Label::periodic ? fmt::format("{}, period {}", label, result.period) : label;
    one["stable"] = result.label == Label::periodic || result.label == Label::equilibrium ||
                    result.label == Label::quasi_periodic || result.label == Label::chaotic;
    one["period"] = result.duration > 0 ? number_json(result.duration) : nlohmann::json();
    one["parameters"] = parameters_json(model_of_point(run, point));
    PointFacts facts;
    facts.add("label", label);
    if (result.period > 0)
        facts.add("repeats after", fmt::format("{} return{}", result.period, result.period == 1 ? "" : "s"));
    if (result.duration > 0)
        facts.add("duration", result.duration, time_unit);
    facts.add("signature", result.signature);
    if (result.symmetric)
        facts.add("symmetric", *result.symmetric ? "yes" : "no");
    if (result.lyapunov)
        facts.add("Lyapunov exponent", result.lyapunov_error
                                           ? fmt::format("{:.4g} +- {:.2g}", *result.lyapunov, *result.lyapunov_error)
                                           : fmt::format("{:.4g}", *result.lyapunov));
    if (result.label == Label::periodic)
        facts.add("residual", result.residual);
    facts.add(has_settled(result.label) ? "returns until settled" : "returns", static_cast<double>(result.cycles));
    facts.add("simulated time", result.time, time_unit);
    facts.add("ending", early_ending(result.outcome.ending));
    facts.add("detail", result.outcome.detail);
    if (!name_at(run.record.directions, point.direction).empty())
        facts.add("direction", name_at(run.record.directions, point.direction));
    one["facts"] = facts.take();
    add_samples(one, run, result.samples);
    return one;
}

nlohmann::json record_point_json(const StoredRun& run, const PointRecord& point) {
    nlohmann::json one = plain_point_json(run, point);
    one["kind"] = "record";
    if (run.record.kind == name_of(RunKind::identify)) {
        ResultTableRequest request;
        request.what = "estimates";
        request.runs = {run.record.name};
        ResultTable estimates = result_table(run.file, request);
        one["tables"].push_back(table_json("estimates", std::move(estimates.rows), estimates.units, most_samples));
    }
    add_samples(one, run, point.result.samples);
    return one;
}

} // namespace

nlohmann::json point_json(const StoredRun& run, std::size_t number) {
    nlohmann::json one;
    if (run.record.is_branch())
        one = orbit_json(run, orbit_numbered(run, number));
    else if (is_measured_run(run.record))
        one = record_point_json(run, point_numbered(run, number));
    else
        one = motion_point_json(run, point_numbered(run, number));
    one["run"] = run.record.name;
    return one;
}

nlohmann::json point_json(const ResultFile& file, const std::string& run, std::size_t number) {
    return point_json(StoredRun(file, run, {}), number);
}

} // namespace graze
