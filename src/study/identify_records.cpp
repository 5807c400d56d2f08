#include "graze/study/identify_records.hpp"

#include "graze/model/named_value.hpp"
#include "study/estimate_kind.hpp"
#include "study/identify_units.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace graze {

namespace {

/// Evaluates numbers that depend on parameters, some of which other runs have found.
class KnownNumbers {
public:
    KnownNumbers(const StudyRun& run, const std::vector<EstimateRecords>& found)
        : model_(run.model), found_(&found), place_(run.place) {}

    /// The value, with the error that propagates from those of the parameters, to first order.
    Estimate value(const std::string& text) {
        Estimate result;
        result.value = value_of_text(model_, text, place_);
        double variance = 0;
        for (const EstimateRecords& records : *found_) {
            std::vector<double> slopes;
            for (const EstimateRecord& number : records.numbers)
                slopes.push_back(slope(text, number));
            const std::size_t count = slopes.size();
            for (std::size_t i = 0; i < count; ++i)
                for (std::size_t j = 0; j < count; ++j) {
                    const double covariance =
                        !records.covariance.empty() ? records.covariance[i * count + j]
                        : i == j ? records.numbers[i].estimate.error * records.numbers[i].estimate.error
                                 : 0;
                    variance += slopes[i] * slopes[j] * covariance;
                }
        }
        result.error = std::sqrt(std::max(variance, 0.0));
        return result;
    }

private:
    /// The derivative by a parameter, by differences of one standard error, over which the expression is taken as
    /// linear.
    double slope(const std::string& text, const EstimateRecord& number) {
        const double error = number.estimate.freedom > 0 ? number.estimate.error : 0;
        const auto parameter = model_.find_independent_parameter(number.name);
        if (!(error > 0) || !parameter)
            return 0;
        const double before = model_.parameter_values()[parameter->place()];
        const auto at = [&](double value) {
            model_.set_parameter(number.name, value);
            return value_of_text(model_, text, place_);
        };
        const double above = at(before + error), below = at(before - error);
        model_.set_parameter(number.name, before);
        return (above - below) / (2 * error);
    }

    Model model_;
    const std::vector<EstimateRecords>* found_;
    Place place_;
};

IdentificationSettings identification_settings(const StudyRun& run, const std::vector<EstimateRecords>& found,
                                               std::size_t count) {
    const IdentifyRequest& request = run.identify();
    KnownNumbers known(run, found);
    IdentificationSettings settings;
    settings.channel = request.channel;
    settings.displacement = request.displacement;
    settings.voltage = request.voltage;
    settings.current = request.current;
    settings.peaks = request.peaks;
    settings.impacts = request.impacts;
    settings.displacement_noise = request.displacement_noise;
    settings.current_noise = request.current_noise;
    settings.one_load_a_record = count > 1 && !request.each_row;
    const auto value = [&](const std::string& text, double error) -> std::optional<Estimate> {
        if (text.empty())
            return std::nullopt;
        Estimate estimate = known.value(text);
        estimate.error = std::hypot(estimate.error, error);
        return estimate;
    };
    const auto take = [&](const std::optional<Estimate>& estimate, std::optional<double>& number, double& error) {
        if (estimate)
            number = estimate->value, error = estimate->error;
    };
    take(value(request.gap, request.gap_error), settings.gap, settings.gap_error);
    take(value(request.stiffness, request.stiffness_error), settings.stiffness, settings.stiffness_error);
    settings.beta1 = value(request.beta1, request.beta1_error);
    settings.beta2 = value(request.beta2, request.beta2_error);
    if (!request.clamped.empty())
        settings.clamped = known.value(request.clamped).value;
    if (!request.frequency.empty())
        settings.frequency = known.value(request.frequency).value;
    return settings;
}

} // namespace

Identification identify_records(const StudyRun& run, const EachRecord& records, std::size_t count,
                                const std::vector<EstimateRecords>& found) {
    const EachRecord checked = [&](const auto& work) {
        records([&](const std::string& name, SampleSource& record) {
            check_record_units(run, record.header());
            work(name, record);
        });
    };
    const auto identify = estimate_kind(run.identify().what).identify;
    if (!identify)
        throw InputError(run.place, "a fit needs all records at once", "call fit_records");
    return identify(checked, identification_settings(run, found, count));
}

} // namespace graze
