#include "graze/record/period.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/record/harmonic.hpp"
#include "record/local_polynomial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr std::size_t margin = 3; ///< rows kept before and after a period
constexpr std::size_t longest_period = 4'000'000;

} // namespace

PeriodSplitter::PeriodSplitter(std::shared_ptr<SampleSource> source, const PeriodSettings& settings)
    : source_(required(std::move(source), "a source")), settings_(settings) {
    require_index(settings.reference, source_->header().channels.size(), "channel");
    require_finite(settings.level, "the level of the reference");
    require_finite(settings.hysteresis, "the hysteresis of the reference");
    if (settings.hysteresis < 0)
        throw InputError("the hysteresis of the reference is negative", "give a positive one, or 0");
    buffer_.clear(source_->header().channels.size());
}

bool PeriodSplitter::read_more() {
    const std::size_t needed = has_last_ ? last_.row : armed_ ? below_ : scanned_;
    const std::size_t kept = std::min(needed, scanned_), drop = kept > margin ? kept - margin : 0;
    buffer_.drop_front(drop);
    scanned_ -= drop;
    below_ -= std::min(below_, drop);
    last_.row -= std::min(last_.row, drop);
    if (buffer_.rows() > longest_period)
        throw InputError(fmt::format("the reference '{}' does not rise through {} for more than {} samples",
                                     source_->header().channels[settings_.reference].name, settings_.level,
                                     longest_period),
                         "choose another reference channel or another level");
    if (!source_->read(part_))
        return false;
    buffer_.append(part_);
    if (!begun_ && settings_.hysteresis == 0) {
        const std::vector<double>& values = buffer_.values[settings_.reference];
        const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
        constexpr double share = 0.1;
        settings_.hysteresis = share * (*greatest - *least);
    }
    begun_ = true;
    return true;
}

double PeriodSplitter::locate(std::size_t below, std::size_t above) const {
    const std::vector<double>& values = buffer_.values[settings_.reference];
    const std::size_t first = below > 0 ? below - 1 : 0, last = std::min(above + 1, buffer_.rows() - 1);
    const double middle = 0.5 * (buffer_.times[below] + buffer_.times[above]);
    const double scale = buffer_.times[last] - buffer_.times[first];
    std::vector<double> places, heights;
    for (std::size_t i = first; i <= last; ++i) {
        places.push_back((buffer_.times[i] - middle) / scale);
        heights.push_back(values[i] - settings_.level);
    }
    constexpr std::size_t cubic = 3;
    const LocalPolynomial polynomial(places, std::min(cubic, places.size() - 1));
    const std::vector<double> powers = polynomial.powers(heights.data());
    const auto height = [&](double x) { return polynomial_at(powers, x); };
    // The samples change their sign between the two rows. If the polynomial does not, use a straight line.
    double low = (buffer_.times[below] - middle) / scale, high = (buffer_.times[above] - middle) / scale;
    if (!(height(low) < 0 && height(high) > 0)) {
        const double fall = values[below] - settings_.level, rise = values[above] - settings_.level;
        return middle + scale * (low - fall / (rise - fall) * (high - low));
    }
    constexpr int bits = 60; // more than a double has
    for (int i = 0; i < bits; ++i) {
        const double x = 0.5 * (low + high);
        (height(x) < 0 ? low : high) = x;
    }
    return middle + scale * 0.5 * (low + high);
}

bool PeriodSplitter::next_crossing(Crossing& crossing) {
    for (;;) {
        const std::vector<double>& values = buffer_.values[settings_.reference];
        for (; scanned_ < buffer_.rows(); ++scanned_) {
            const double height = values[scanned_] - settings_.level;
            if (height < -settings_.hysteresis) {
                armed_ = true;
                below_ = scanned_;
            } else if (armed_ && height > settings_.hysteresis) {
                if (scanned_ + margin >= buffer_.rows() && read_more())
                    break; // this has moved the rows: look at this one again
                crossing.time = locate(below_, scanned_);
                const auto after = std::upper_bound(buffer_.times.begin() + static_cast<std::ptrdiff_t>(below_),
                                                    buffer_.times.end(), crossing.time);
                crossing.row = static_cast<std::size_t>(after - buffer_.times.begin()) - 1;
                armed_ = false;
                ++scanned_;
                return true;
            }
        }
        if (scanned_ >= buffer_.rows() && !read_more())
            return false;
    }
}

bool PeriodSplitter::next(Period& period) {
    if (!has_last_) {
        if (!next_crossing(last_))
            return false;
        has_last_ = true;
    }
    Crossing crossing;
    if (!next_crossing(crossing))
        return false;
    period.number = number_++;
    period.begin = last_.time;
    period.end = crossing.time;
    period.samples.clear(buffer_.values.size());
    period.samples.append(buffer_, last_.row - std::min(last_.row, margin - 1),
                          std::min(buffer_.rows(), crossing.row + margin + 1));
    last_ = crossing;
    return true;
}

PeriodFit fit_period(std::span<const double> crossings) {
    require_finite(crossings, "the time of a crossing");
    if (crossings.size() < 2)
        throw InputError("the reference crosses its level less than twice", "record more periods");
    const auto count = static_cast<double>(crossings.size());
    const double middle = 0.5 * (count - 1);
    const double first = crossings.front(), step = (crossings.back() - first) / (count - 1);
    // Deviations from the line through the first and the last crossing are small, so that no digits are lost.
    double mean = 0, moment = 0;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
        const auto k = static_cast<double>(i);
        const double departure = crossings[i] - first - k * step;
        mean += departure / count;
        moment += (k - middle) * departure;
    }
    const double spread = count * (count * count - 1) / 12;
    PeriodFit fit;
    fit.crossings = crossings.size();
    const double more = moment / spread;
    fit.period = step + more;
    fit.begin = first + mean - middle * more;
    if (crossings.size() == 2)
        return fit;
    double squares = 0;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
        const auto k = static_cast<double>(i);
        squares += std::pow(crossings[i] - first - k * step - mean - (k - middle) * more, 2);
    }
    fit.jitter = std::sqrt(squares / (count - 2));
    fit.period_error = fit.jitter / std::sqrt(spread);
    fit.begin_error = fit.jitter * std::sqrt(1 / count + middle * middle / spread);
    return fit;
}

RecordPeriods each_period(SampleSource& source, const PeriodSettings& settings,
                          const std::function<void(const Period&)>& take) {
    PeriodSplitter splitter(borrowed(source), settings);
    RecordPeriods found;
    double sum = 0;
    for (Period period; splitter.next(period); ++found.count) {
        sum += amplitude(period, settings.reference);
        take(period);
    }
    if (found.count == 0)
        throw InputError(fmt::format("'{}' does not rise through {} twice",
                                     source.header().channels[settings.reference].name, settings.level),
                         "choose another reference or level, or record more periods");
    found.amplitude = sum / static_cast<double>(found.count);
    return found;
}

} // namespace graze
