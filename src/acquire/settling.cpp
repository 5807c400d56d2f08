#include "graze/acquire/settling.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/record/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// A device's samples as a source; counts them and reports progress.
class DeviceSource : public SampleSource {
public:
    DeviceSource(SampleDevice& device, double rate, const std::function<void(double)>& progress)
        : device_(&device), rate_(rate), progress_(&progress) {}
    const RecordHeader& header() const override { return device_->header(); }
    bool read(Samples& samples) override {
        const bool some = device_->read(samples);
        taken_ += samples.rows();
        if (*progress_)
            (*progress_)(time());
        return some;
    }
    std::size_t taken() const { return taken_; }
    double time() const { return static_cast<double>(taken_) / rate_; }

private:
    SampleDevice* device_;
    double rate_;
    const std::function<void(double)>* progress_;
    std::size_t taken_ = 0;
};

std::size_t rows_of(double time, double rate) {
    return static_cast<std::size_t>(std::llround(time * rate));
}

} // namespace

RepeatWatch::RepeatWatch(std::vector<double> tolerances, std::size_t repeats, std::size_t period)
    : tolerances_(std::move(tolerances)), repeats_(repeats), longest_(period) {
    constexpr std::size_t most = 100'000; // sections that are stored
    require_finite(tolerances_, "the tolerance of a section");
    if (std::any_of(tolerances_.begin(), tolerances_.end(), [](double one) { return one < 0; }))
        throw InputError("the tolerance of a section is negative", "give a positive one, or 0");
    if (repeats_ == 0 || longest_ == 0 || longest_ > most)
        throw InputError(fmt::format("{} sections of periods up to {} cannot be compared", repeats_, longest_),
                         fmt::format("compare one or more, of periods up to {} at most", most));
    runs_.assign(longest_, 0);
}

bool RepeatWatch::close(const std::vector<double>& one, const std::vector<double>& other) const {
    for (std::size_t i = 0; i < tolerances_.size(); ++i)
        if (!(std::abs(one[i] - other[i]) <= tolerances_[i]))
            return false;
    return true;
}

void RepeatWatch::add(std::vector<double> section) {
    require_size(section.size(), tolerances_.size(), "values of a section");
    require_finite(section, "a value of a section");
    for (std::size_t p = 1; p <= longest_; ++p) {
        const bool repeats = last_.size() >= p && close(section, last_[last_.size() - p]);
        runs_[p - 1] = repeats ? runs_[p - 1] + 1 : 0;
    }
    last_.push_back(std::move(section));
    if (last_.size() > longest_)
        last_.erase(last_.begin());
}

std::size_t RepeatWatch::period() const {
    for (std::size_t p = 1; p <= longest_; ++p)
        if (runs_[p - 1] / p >= repeats_)
            return p;
    return 0;
}

Settled settle(SampleDevice& device, const SettlingOptions& options, double rate,
               const std::function<void(double)>& progress) {
    const std::size_t least = rows_of(options.time, rate), most = rows_of(options.most, rate);
    DeviceSource source(device, rate, progress);
    Samples part;
    if (options.reference.empty()) {
        if (least > 0)
            device.begin(least);
        while (least > 0 && source.read(part))
            continue;
        return {true, source.time()};
    }
    const std::size_t reference = device.header().channel(options.reference, "settle.reference");
    std::vector<std::size_t> channels;
    std::vector<double> tolerances;
    for (const SettlingOptions::Tolerance& tolerance : options.tolerances) {
        channels.push_back(device.header().channel(tolerance.channel, "settle.tolerance"));
        tolerances.push_back(tolerance.size);
    }
    RepeatWatch watch(tolerances, options.repeats, options.period);
    if (most == 0)
        return {false, 0};
    // Read in small blocks, so that no unused samples are taken: a simulated experiment is then reproducible.
    constexpr double part_of_second = 0.125;
    device.begin(most, static_cast<std::size_t>(std::clamp(part_of_second * rate, 16.0, 1024.0)));
    PeriodSplitter splitter(borrowed(source), {reference});
    Period period;
    bool settled = false;
    while (!settled && splitter.next(period)) {
        const SectionPoint point = section(period, options.phase);
        std::vector<double> values;
        for (const std::size_t channel : channels)
            values.push_back(point.values[channel]);
        watch.add(std::move(values));
        settled = watch.period() > 0 && source.taken() >= least;
    }
    const double time = source.time();
    if (settled)
        device.stop();
    return {settled, time};
}

} // namespace graze
