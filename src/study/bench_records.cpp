#include "study/bench_records.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr double generator_frequency = 1000;  ///< Hz, as after it is switched on
constexpr double largest_amplitude = 5;       ///< V, half of what the generator gives from peak to peak
constexpr std::size_t samples_at_once = 8192; ///< samples between two questions whether to go on

} // namespace

void BenchRecords::begin(std::size_t number) {
    BenchSettings settings;
    settings.model = bench_->model;
    const std::vector<std::string> names = settings.model.independent_parameters();
    double largest = 0;
    for (const double level : bench_->levels)
        largest = std::max(largest, std::abs(level));
    settings.amplitude.parameter = settings.model.independent_parameter(bench_->parameter);
    factor_ = largest / largest_amplitude;
    settings.amplitude.factor = factor_;
    // The other parameter keeps its value.
    const std::size_t other = settings.amplitude.parameter.place() == 0 ? 1 : 0;
    settings.frequency.parameter = settings.model.independent_parameter(names[other]);
    settings.frequency.factor = settings.model.parameter_values()[other] / generator_frequency;
    settings.time_unit = bench_->time_unit;
    settings.channels = bench_->channels;
    settings.bits = bench_->bits;
    settings.anti_alias = bench_->anti_alias;
    settings.seed = bench_->carry ? bench_->seed : bench_->seed + 7919 * number;
    if (!bench_->carry) { // the level is exact
        settings.amplitude.factor = bench_->levels[number % bench_->levels.size()] / largest_amplitude;
        factor_ = 0;
    }
    instrument_ = std::make_unique<VirtualBench>(settings);
    instrument_->set_rate(bench_->rate);
    header_ = instrument_->header();
    if (!bench_->carry)
        drive(2 * largest_amplitude);
    next_ = number;
}

void BenchRecords::drive(double amplitude) {
    GeneratorOutput output;
    output.frequency = generator_frequency;
    output.amplitude = amplitude;
    instrument_->drive(output);
}

bool BenchRecords::take(std::size_t number, const std::function<bool()>& interrupted, Samples& samples) {
    const double level = bench_->levels[number % bench_->levels.size()];
    if (bench_->carry) {
        const double amplitude = factor_ > 0 ? 2 * level / factor_ : 0;
        if (!GeneratorOutput::reaches(amplitude))
            throw InputError(
                fmt::format("the generator of the bench cannot be set to {} = {}", bench_->parameter, level),
                "levels may be from 1/200 of the largest one up to it; with carry = false any");
        drive(amplitude);
    }
    // In parts as long as those of the samples, so that settling can be interrupted.
    const double stretch = static_cast<double>(samples_at_once) / bench_->rate;
    for (double left = bench_->settle; left > 0; left -= stretch) {
        if (interrupted && interrupted())
            return false;
        instrument_->pass(std::min(left, stretch));
    }
    samples.clear(header_.channels.size());
    Samples some;
    for (auto left = static_cast<std::size_t>(std::llround(bench_->rate * bench_->time)); left > 0;) {
        if (interrupted && interrupted())
            return false;
        const std::size_t count = std::min(left, samples_at_once);
        instrument_->sample(count, some);
        samples.append(some);
        left -= count;
        if (!instrument_->ended().empty())
            throw InputError(fmt::format("at {} = {} {}", bench_->parameter, level, instrument_->ended()),
                             "choose other levels, or another model");
    }
    return true;
}

std::optional<Samples> BenchRecords::record(std::size_t number, const std::function<bool()>& interrupted) {
    if (!bench_->carry)
        begin(number);
    else if (!instrument_ || number < next_)
        begin(0);
    Samples samples;
    for (; next_ <= number; ++next_)
        if (!take(next_, interrupted, samples)) {
            instrument_.reset();
            return std::nullopt;
        }
    // The time of each record begins at zero.
    const double begin = samples.times.front();
    for (double& time : samples.times)
        time -= begin;
    return samples;
}

} // namespace graze
