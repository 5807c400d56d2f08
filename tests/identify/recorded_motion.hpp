#pragma once

#include "graze/identify/fit.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/trajectory/recorder.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "identify/noise.hpp"

#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

namespace graze::testing {

/// A motion of a model with exact readings of it, as a fit task without unknowns.
struct RecordedMotion {
    Model model;
    FitTask task;
    std::vector<double> first; ///< state at the first reading
    std::size_t contacts = 0;

    /// @param channels states or quantities. @param skipped time before the first reading
    RecordedMotion(Model measured, const std::vector<std::string>& channels, double skipped, double spacing,
                   std::size_t count, double tolerance = 1e-14)
        : model(std::move(measured)) {
        add_record(channels, skipped, spacing, count, tolerance);
    }
    void add_record(const std::vector<std::string>& channels, double skipped, double spacing, std::size_t count,
                    double tolerance = 1e-14) {
        FitRecord record;
        std::vector<Expression> values;
        for (const std::string& name : channels) {
            MeasuredOutput output;
            output.name = name;
            const auto quantity = model.find_quantity(name);
            output.value = quantity ? model.quantities[*quantity].value : model.symbol(name);
            values.push_back(output.value);
            FitRecord::Readings readings;
            readings.output = task.records.empty() ? task.outputs.size() : readings_of(name);
            record.readings.push_back(readings);
            if (task.records.empty())
                task.outputs.push_back(output);
        }
        const Function outputs = model.function_of(values);
        const std::vector<double> parameters = model.parameter_values();
        Sampler sampler(skipped, spacing, count, model.periods(),
                        [&](double time, std::size_t mode, std::span<const double> state) {
                            if (record.times.empty()) {
                                record.mode = mode;
                                first.assign(state.begin(), state.end());
                            }
                            record.times.push_back(time);
                            std::vector<double> inputs(state.begin(), state.end());
                            inputs.insert(inputs.end(), parameters.begin(), parameters.end());
                            const std::vector<double> read = outputs(inputs);
                            for (std::size_t c = 0; c < read.size(); ++c)
                                record.readings[c].values.push_back(read[c]);
                        });
        Recorder recorder;
        Relay relay({borrowed(sampler), borrowed(recorder)});
        const Simulation simulation(System(model), {}, {}, {.tolerance = tolerance});
        Trajectory trajectory(simulation, parameters, borrowed(relay));
        trajectory.start(model.initial_state(), model.initial_mode, 0, skipped + spacing * static_cast<double>(count));
        JetSet jets(simulation, LaneKind::single);
        run(trajectory, jets);
        contacts = recorder.contacts().size();
        task.records.push_back(std::move(record));
    }
    std::size_t readings_of(const std::string& name) const {
        for (std::size_t o = 0; o < task.outputs.size(); ++o)
            if (task.outputs[o].name == name)
                return o;
        return 0;
    }
    /// Makes a parameter unknown, with its value times a factor as guess.
    void forget(const std::string& parameter, double factor) {
        const ParameterId unknown = model.independent_parameter(parameter);
        task.parameters.push_back({unknown, factor * model.parameter_values()[unknown.place()]});
    }
    void forget_states() {
        for (FitRecord& record : task.records)
            for (std::size_t i = 0; i < model.states.size(); ++i)
                record.unknown_states.push_back(i);
    }
    /// Makes these parameters and all initial states unknown.
    void forget_all(std::initializer_list<const char*> parameters, double factor) {
        for (const char* name : parameters)
            forget(name, factor);
        forget_states();
    }
    void add_noise(double deviation_by_range, std::uint64_t seed) {
        Noise noise(seed);
        for (FitRecord& record : task.records)
            for (FitRecord::Readings& readings : record.readings) {
                const auto [least, greatest] = std::minmax_element(readings.values.begin(), readings.values.end());
                const double deviation = deviation_by_range * (*greatest - *least);
                for (double& value : readings.values)
                    value += deviation * noise.normal();
            }
    }
    Fit fit(const FitSettings& settings = {}) const { return fit_model(System(model), task, settings); }
    /// The fit, which is expected to converge.
    Fit converged(const FitSettings& settings = {}) const {
        Fit result = fit(settings);
        EXPECT_EQ(name_of(result.ending), "converged") << result.detail;
        return result;
    }
    /// Expects each parameter within four standard errors of the truth.
    void expect_within_errors(const Fit& fit) const {
        for (std::size_t j = 0; j < task.parameters.size(); ++j)
            EXPECT_LE(std::abs(fit.numbers[j].estimate.value - truth(j)), 4 * fit.numbers[j].estimate.error)
                << fit.numbers[j].name;
    }
    double truth(std::size_t parameter) const {
        return model.parameter_values()[task.parameters[parameter].parameter.place()];
    }
    /// Largest relative error of the parameters.
    double error(const Fit& fit) const {
        double largest = 0;
        for (std::size_t j = 0; j < task.parameters.size(); ++j)
            largest = std::max(largest, std::abs(fit.numbers[j].estimate.value / truth(j) - 1));
        return largest;
    }
};

} // namespace graze::testing
