#include "graze/branch/yield.hpp"

#include "base/random_number.hpp"
#include "base/thread_team.hpp"
#include "base/turns.hpp"
#include "branch/examined_yield.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>
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

/// Solves for devices on several threads.
class DeviceThreads {
public:
    DeviceThreads(const AskedDevices& devices, int jobs) : devices_(devices) {
        constexpr std::size_t enough = 32; // number of devices that justifies a thread
        threads_ = std::clamp<std::size_t>(devices.count / enough, 1, static_cast<std::size_t>(jobs));
    }
    /// @param sink called by several threads at once, for different devices
    /// @param progress called by the calling thread
    /// @return false when it was interrupted
    bool solve_all(const std::function<bool()>& interrupted, const DeviceSink& sink,
                   const std::function<void(std::size_t)>& progress) {
        team_.run(threads_, [&](bool calling) {
            for (std::size_t i; !team_.is_stopped() && (i = next_++) < devices_.count;) {
                if (interrupted && interrupted())
                    return team_.stop();
                SolvedDevice solved = devices_.solver.solve(devices_.changes(i), interrupted);
                sink(i, solved);
                const std::size_t finished = ++done_;
                if (calling && progress)
                    progress(finished);
            }
        });
        return !team_.is_stopped();
    }

private:
    const AskedDevices& devices_;
    std::size_t threads_;
    std::atomic<std::size_t> next_{0}, done_{0};
    ThreadTeam team_;
};

/// Why devices were not found; from any thread.
class Problems {
public:
    void add(const std::string& problem) {
        if (problem.empty())
            return;
        const std::lock_guard lock(mutex_);
        ++counts_[problem];
    }
    /// With the number of devices of each, the most frequent one first.
    std::vector<std::pair<std::string, std::size_t>> sorted() const {
        std::vector<std::pair<std::string, std::size_t>> result(counts_.begin(), counts_.end());
        std::stable_sort(result.begin(), result.end(),
                         [](const auto& a, const auto& b) { return a.second > b.second; });
        return result;
    }

private:
    std::mutex mutex_;
    std::map<std::string, std::size_t> counts_;
};

/// Solves for all devices, by threads or elsewhere.
ExaminedYield solve_all(const AskedDevices& devices, const YieldSettings& settings) {
    ExaminedYield result;
    Yield& yield = result.yield;
    yield.nominal = devices.solver.value();
    yield.devices.resize(devices.count);
    result.examined.resize(devices.solver.examination().examine ? devices.count : 0);
    Problems problems;
    const DeviceSink sink = [&](std::size_t i, SolvedDevice& solved) {
        yield.devices[i] = solved.device;
        problems.add(solved.problem);
        if (!result.examined.empty())
            result.examined[i] = std::move(solved.examined);
    };
    const Turns turns;
    const std::function<bool()> interrupted = turns.asking(settings.interrupted);
    const std::function<void(std::size_t)> progress = turns.taking(settings.progress);
    if (settings.elsewhere) {
        std::size_t done = 0;
        yield.interrupted = !settings.elsewhere(devices, interrupted, [&](std::size_t i, SolvedDevice& solved) {
            require_index(i, devices.count, "device");
            sink(i, solved);
            ++done;
            if (progress)
                progress(done);
        });
    } else {
        yield.interrupted = !DeviceThreads(devices, settings.jobs).solve_all(interrupted, sink, progress);
    }
    yield.problems = problems.sorted();
    return result;
}

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

void set_contributions(Yield& result, const DeviceSolver& nominal, const std::vector<Tolerance>& tolerances) {
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
    const DeviceSolver solver(system, point, control, others, settings.solver);
    const auto drawn_changes = [&](std::size_t device) {
        std::vector<double> changes(others.size());
        for (std::size_t k = 0; k < changes.size(); ++k)
            changes[k] = random_deviation(settings.tolerances[k], settings.seed, device, k);
        return changes;
    };
    Yield result = solve_all({solver, settings.devices, drawn_changes}, settings).yield;
    set_contributions(result, solver, settings.tolerances);
    add_statistics(result, settings);
    return result;
}

Yield yield_of(const System& system, const SpecialPoint& point, ParameterId control, const MadeDevices& devices,
               const YieldSettings& settings) {
    return examined_yield_of(system, point, control, devices, settings, {}).yield;
}

ExaminedYield examined_yield_of(const System& system, const SpecialPoint& point, ParameterId control,
                                const MadeDevices& devices, const YieldSettings& settings,
                                DeviceExamination examination) {
    require_number_of(devices.values.size());
    require_common(settings);
    for (const std::vector<double>& values : devices.values)
        if (!values.empty() && values.size() != devices.parameters.size())
            throw InputError(
                fmt::format("a device has {} values of {} parameters", values.size(), devices.parameters.size()),
                "give one for each");
    const DeviceSolver solver(system, point, control, devices.parameters, settings.solver, std::move(examination));
    const auto changes_of = [&](std::size_t device) {
        std::vector<double> changes = devices.values[device];
        for (std::size_t k = 0; k < changes.size(); ++k)
            changes[k] -= solver.values()[k];
        return changes;
    };
    ExaminedYield result = solve_all({solver, devices.values.size(), changes_of}, settings);
    result.yield.linear_deviation = deviation_of_linear(result.yield);
    add_statistics(result.yield, settings);
    return result;
}

} // namespace graze
