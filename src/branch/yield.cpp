#include "graze/branch/yield.hpp"

#include "base/random_number.hpp"
#include "base/thread_team.hpp"
#include "base/turns.hpp"
#include "branch/solved_devices.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>

namespace graze {

namespace {

/// Returns the random deviation of a parameter from its nominal value.
double random_deviation(const Tolerance& tolerance, std::uint64_t seed, std::size_t device, std::size_t place) {
    if (tolerance.spread == Spread::uniform)
        return tolerance.size * (2 * drawn(seed, device, 2 * place) - 1);
    return tolerance.size * drawn_normal(seed, device, place);
}

/// Returns the half width, in standard deviations, of the central interval that contains a share of a normal
/// distribution.
double half_width_in_deviations(double share) {
    double low = 0, high = 40;
    while (true) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high)
            return middle;
        (std::erf(middle / std::numbers::sqrt2) < share ? low : high) = middle;
    }
}

void require_share(double share, const char* what) {
    if (!(share > 0 && share < 1))
        throw InputError(fmt::format("{} {} is out of range", what, share), "choose one between 0 and 1");
}

/// Solves for all devices, on several threads.
struct DeviceSolver {
    /// Returns the changes of a device's parameters from the nominal ones; empty: the device cannot be made.
    using Changes = std::function<std::vector<double>(std::size_t device, const std::vector<double>& nominal)>;

    const System& system;
    const SpecialPoint& point;
    ParameterId control;
    std::vector<ParameterId> others;
    std::size_t devices;
    Changes changes;
    const YieldSettings& settings;
    SolvedDevice solved{};
    LocatedValue nominal = make_solver();
    std::vector<std::string> problems{};
    std::atomic<std::size_t> next{0}, done{0};
    Turns turns{};
    std::function<bool()> interrupted = turns.asking(settings.interrupted);
    std::function<void(std::size_t)> progress = turns.taking(settings.progress);
    ThreadTeam team{};

    Yield solve_all() {
        Yield result;
        result.nominal = nominal.value();
        result.devices.resize(devices);
        problems.resize(devices);
        constexpr std::size_t enough = 32; // number of devices that justifies a thread
        const std::size_t jobs = std::clamp<std::size_t>(devices / enough, 1, static_cast<std::size_t>(settings.jobs));
        team.run(jobs, [&](bool calling) {
            if (calling)
                return work(nominal, result, true);
            LocatedValue one = make_solver();
            work(one, result, false);
        });
        result.interrupted = team.is_stopped();
        std::map<std::string, std::size_t> counts;
        for (const std::string& problem : problems)
            if (!problem.empty())
                ++counts[problem];
        result.problems.assign(counts.begin(), counts.end());
        std::stable_sort(result.problems.begin(), result.problems.end(),
                         [](const auto& a, const auto& b) { return a.second > b.second; });
        return result;
    }

    LocatedValue make_solver() const { return {system, point, control, others, settings.solver}; }

    void work(LocatedValue& solver, Yield& result, bool reports_progress) {
        for (std::size_t i; !team.is_stopped() && (i = next++) < devices;) {
            if (interrupted && interrupted())
                return team.stop();
            problems[i] = solve(solver, i, result.devices[i]);
            const std::size_t finished = ++done;
            if (reports_progress && progress)
                progress(finished);
        }
    }

    /// @return why the device was not found; empty otherwise
    std::string solve(LocatedValue& solver, std::size_t i, Device& device) const {
        device.outcome = DeviceOutcome::failed;
        device.linear = solver.value();
        std::vector<double> values = solver.values();
        const std::vector<double> moves = changes(i, values);
        if (moves.size() != values.size())
            return "the device cannot be made";
        for (std::size_t k = 0; k < values.size(); ++k) {
            values[k] += moves[k];
            device.linear += solver.derivatives()[k] * moves[k];
        }
        const LocatedSolution found = solver(values);
        if (found.found)
            device.outcome = found.admissible ? DeviceOutcome::found : DeviceOutcome::inadmissible;
        if (device.outcome != DeviceOutcome::found)
            return found.problem.empty() ? "the model would not follow the orbit" : found.problem;
        device.value = found.value;
        if (solved)
            solved(i, found);
        return {};
    }
};

void count(Yield& result) {
    const auto number_of = [&](DeviceOutcome outcome) {
        return static_cast<std::size_t>(std::count_if(result.devices.begin(), result.devices.end(),
                                                      [&](const Device& device) { return device.outcome == outcome; }));
    };
    result.found = number_of(DeviceOutcome::found);
    result.inadmissible = number_of(DeviceOutcome::inadmissible);
    result.failed = number_of(DeviceOutcome::failed);
    result.made = result.found + result.inadmissible + result.failed;
}

/// Sets mean and standard deviation, computed from differences to the nominal value to avoid cancellation.
void set_moments(Yield& result, const std::vector<double>& values, double confidence) {
    const auto n = static_cast<double>(values.size());
    if (values.size() < 2)
        return;
    double sum = 0;
    for (const double value : values)
        sum += value - result.nominal;
    const double mean = sum / n;
    double second = 0, fourth = 0;
    for (const double value : values) {
        const double square = (value - result.nominal - mean) * (value - result.nominal - mean);
        second += square;
        fourth += square * square;
    }
    const double variance = second / (n - 1), deviation = std::sqrt(variance), z = half_width_in_deviations(confidence);
    const double of_mean = z * deviation / std::sqrt(n);
    const double spread = std::max(0.0, fourth / n - variance * variance);
    const double of_deviation = deviation > 0 ? z * std::sqrt(spread / n) / (2 * deviation) : 0;
    const double centre = result.nominal + mean;
    result.mean = ConfidenceInterval{centre, centre - of_mean, centre + of_mean};
    result.deviation = ConfidenceInterval{deviation, std::max(0.0, deviation - of_deviation), deviation + of_deviation};
}

/// Estimates a quantile. The number of values below it is binomial, so its confidence limits are order statistics.
/// @param values sorted
QuantileEstimate quantile_of(const std::vector<double>& values, double share, double confidence) {
    const std::size_t n = values.size();
    const auto count = static_cast<double>(n);
    QuantileEstimate result;
    result.share = share;
    const double place = share * (count - 1);
    const auto below = static_cast<std::size_t>(place);
    const double rest = place - static_cast<double>(below);
    result.value = values[below] + (below + 1 < n ? rest * (values[below + 1] - values[below]) : 0);
    const double outside = 0.5 * (1 - confidence);
    double cumulative = 0;
    for (std::size_t k = 0; k < n; ++k) { // cumulative: probability of at most k values below
        const auto hits = static_cast<double>(k);
        cumulative += std::exp(std::lgamma(count + 1) - std::lgamma(hits + 1) - std::lgamma(count - hits + 1) +
                               hits * std::log(share) + (count - hits) * std::log1p(-share));
        if (cumulative <= outside)
            result.low = values[k];
        if (cumulative >= 1 - outside) {
            result.high = values[k];
            break;
        }
    }
    return result;
}

void set_shares(Yield& result, const YieldSettings& settings) {
    if ((!settings.least && !settings.greatest) || result.made == 0)
        return;
    const auto is_within = [&](double value) {
        return (!settings.least || value >= *settings.least) && (!settings.greatest || value <= *settings.greatest);
    };
    std::size_t within = 0, linear = 0;
    for (const Device& device : result.devices) {
        within += device.outcome == DeviceOutcome::found && is_within(device.value) ? 1 : 0;
        linear += device.outcome != DeviceOutcome::not_made && is_within(device.linear) ? 1 : 0;
    }
    result.within = wilson_interval(within, result.made, settings.confidence);
    result.linear_within = static_cast<double>(linear) / static_cast<double>(result.made);
}

void set_contributions(Yield& result, const LocatedValue& nominal, const std::vector<Tolerance>& tolerances) {
    double sum = 0; // hypot avoids overflow and underflow in any units
    for (std::size_t k = 0; k < tolerances.size(); ++k) {
        const double one = nominal.derivatives()[k] * tolerances[k].deviation();
        result.contributions.push_back({tolerances[k].parameter, one, 0});
        sum = std::hypot(sum, one);
    }
    result.linear_deviation = sum;
    for (Contribution& one : result.contributions)
        one.share = sum > 0 ? (one.deviation / sum) * (one.deviation / sum) : 0;
    std::stable_sort(result.contributions.begin(), result.contributions.end(),
                     [](const Contribution& a, const Contribution& b) { return a.share > b.share; });
}

void require_number_of(std::size_t devices) {
    constexpr std::size_t most = 100'000'000;
    if (devices == 0 || devices > most)
        throw InputError(fmt::format("{} devices are out of range", devices), fmt::format("choose from 1 to {}", most));
}

/// Validates the settings that apply to drawn and to given devices.
void require_common(const YieldSettings& settings) {
    if (settings.least && settings.greatest && !(*settings.least <= *settings.greatest))
        throw InputError(fmt::format("nothing lies within {} and {}", *settings.least, *settings.greatest),
                         "give the lower limit first");
    require_share(settings.confidence, "the confidence");
    for (const double share : settings.quantiles)
        require_share(share, "the quantile");
    if (settings.jobs < 1)
        throw InputError(fmt::format("{} jobs cannot do anything", settings.jobs), "give at least one");
    settings.solver.validate();
}

/// Sets the counts, shares, moments and quantiles of the devices.
void add_statistics(Yield& result, const YieldSettings& settings) {
    count(result);
    set_shares(result, settings);
    std::vector<double> values;
    for (const Device& device : result.devices)
        if (device.outcome == DeviceOutcome::found) {
            values.push_back(device.value);
            result.largest_departure = std::max(result.largest_departure, std::abs(device.value - device.linear));
        }
    set_moments(result, values, settings.confidence);
    std::sort(values.begin(), values.end());
    if (!values.empty())
        for (const double share : settings.quantiles)
            result.quantiles.push_back(quantile_of(values, share, settings.confidence));
}

/// Returns the standard deviation of the linear predictions.
double deviation_of_linear(const Yield& result) {
    std::vector<double> differences;
    for (const Device& device : result.devices)
        if (device.outcome != DeviceOutcome::not_made)
            differences.push_back(device.linear - result.nominal);
    const auto n = static_cast<double>(differences.size());
    if (n < 2)
        return 0;
    const double mean = std::accumulate(differences.begin(), differences.end(), 0.0) / n;
    double squares = 0;
    for (const double one : differences)
        squares += std::pow(one - mean, 2);
    return std::sqrt(squares / (n - 1));
}

} // namespace

double Tolerance::deviation() const {
    return spread == Spread::normal ? size : size / std::numbers::sqrt3;
}

void YieldSettings::validate() const {
    if (tolerances.empty())
        throw InputError("no parameter has a tolerance", "give at least one");
    for (const Tolerance& one : tolerances)
        if (!(one.size >= 0 && std::isfinite(one.size)))
            throw InputError(fmt::format("the tolerance {} is out of range", one.size),
                             "give a number that is not negative");
    require_number_of(devices);
    require_common(*this);
}

ConfidenceInterval wilson_interval(std::size_t hits, std::size_t trials, double confidence) {
    require_share(confidence, "the confidence");
    if (trials == 0 || hits > trials)
        throw InputError(fmt::format("{} of {} is no share", hits, trials),
                         "give at least one trial, and no more hits");
    const auto n = static_cast<double>(trials);
    const double share = static_cast<double>(hits) / n, z = half_width_in_deviations(confidence), z2 = z * z;
    const double centre = (share + z2 / (2 * n)) / (1 + z2 / n);
    const double half = z / (1 + z2 / n) * std::sqrt(share * (1 - share) / n + z2 / (4 * n * n));
    return {share, hits == 0 ? 0 : std::max(0.0, centre - half), hits == trials ? 1 : std::min(1.0, centre + half)};
}

Yield yield_of(const System& system, const SpecialPoint& point, ParameterId control, const YieldSettings& settings) {
    settings.validate();
    std::vector<ParameterId> others;
    for (const Tolerance& one : settings.tolerances)
        others.push_back(one.parameter);
    const auto drawn_changes = [&](std::size_t device, const std::vector<double>& nominal) {
        std::vector<double> changes(nominal.size());
        for (std::size_t k = 0; k < changes.size(); ++k)
            changes[k] = random_deviation(settings.tolerances[k], settings.seed, device, k);
        return changes;
    };
    DeviceSolver solver{system, point, control, others, settings.devices, drawn_changes, settings};
    Yield result = solver.solve_all();
    set_contributions(result, solver.nominal, settings.tolerances);
    add_statistics(result, settings);
    return result;
}

Yield yield_of(const System& system, const SpecialPoint& point, ParameterId control, const MadeDevices& devices,
               const YieldSettings& settings) {
    return yield_of(system, point, control, devices, settings, SolvedDevice());
}

Yield yield_of(const System& system, const SpecialPoint& point, ParameterId control, const MadeDevices& devices,
               const YieldSettings& settings, SolvedDevice solved) {
    require_number_of(devices.values.size());
    require_common(settings);
    for (const std::vector<double>& values : devices.values)
        if (!values.empty() && values.size() != devices.parameters.size())
            throw InputError(
                fmt::format("a device has {} values of {} parameters", values.size(), devices.parameters.size()),
                "give one for each");
    const auto changes_of = [&](std::size_t device, const std::vector<double>& nominal) {
        std::vector<double> changes = devices.values[device];
        for (std::size_t k = 0; k < changes.size(); ++k)
            changes[k] -= nominal[k];
        return changes;
    };
    DeviceSolver solver{system,     point,    control,          devices.parameters, devices.values.size(),
                        changes_of, settings, std::move(solved)};
    Yield result = solver.solve_all();
    result.linear_deviation = deviation_of_linear(result);
    add_statistics(result, settings);
    return result;
}

} // namespace graze
