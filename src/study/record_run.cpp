#include "study/record_run.hpp"

#include "graze/flow/system.hpp"
#include "graze/record/extremes.hpp"
#include "graze/record/harmonic.hpp"
#include "graze/record/impacts.hpp"
#include "graze/record/interpolate.hpp"
#include "graze/record/period.hpp"
#include "graze/record/section.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/transform.hpp"
#include "study/impact_sides.hpp"
#include "study/record_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace graze {

namespace {

constexpr std::size_t most_samples = (std::size_t{1} << 24) - 1; ///< of a record, as the result file takes

/// A record with its channels under the names that the run gives them, followed by the values of the run.
class ValueSource : public SampleSource {
public:
    ValueSource(std::unique_ptr<SampleSource> source, const StudyRun& run)
        : record_(std::move(source), run.record().processing), evaluate_(System(run.model).function_of(run.values)),
          inputs_(evaluate_.inputs()), results_(evaluate_.outputs()), work_(evaluate_.workspace()) {
        const RecordHeader& header = record_.header();
        header_.time = header.time;
        for (std::size_t c = 0; c < run.record().channels.size(); ++c) {
            const RecordRequest::Kept& kept = run.record().channels[c];
            columns_.push_back(header.channel(kept.channel, "channels"));
            const std::string& unit = header.channels[columns_.back()].unit;
            if (unit != run.model.states[c].unit)
                throw InputError(fmt::format("channel '{}' is in '{}', and that of the first record in '{}'",
                                             kept.channel, unit, run.model.states[c].unit),
                                 "make a run of each kind of records, or convert one by `scale`");
            header_.channels.push_back({kept.name, unit});
        }
        if (header.time.unit != run.model.time_unit)
            throw InputError(fmt::format("its time is in '{}', and that of the first record in '{}'", header.time.unit,
                                         run.model.time_unit),
                             "make a run of each kind of records");
        for (std::size_t v = 0; v < run.value_names.size(); ++v)
            header_.channels.push_back({run.value_names[v], run.value_units[v]});
    }
    const RecordHeader& header() const override { return header_; }
    bool read(Samples& samples) override {
        if (!record_.source().read(raw_))
            return samples.clear(header_.channels.size()), false;
        samples.times = raw_.times;
        samples.values.resize(header_.channels.size());
        for (std::size_t c = 0; c < columns_.size(); ++c)
            samples.values[c] = raw_.values[columns_[c]];
        for (std::size_t v = 0; v < results_.size(); ++v)
            samples.values[columns_.size() + v].resize(raw_.rows());
        for (std::size_t row = 0; row < raw_.rows(); ++row) {
            for (std::size_t c = 0; c < columns_.size(); ++c)
                inputs_[c] = samples.values[c][row];
            evaluate_.evaluate(inputs_, results_, work_);
            for (std::size_t v = 0; v < results_.size(); ++v) {
                if (!std::isfinite(results_[v]))
                    throw InputError(fmt::format("'{}' has no finite value at the time {}",
                                                 header_.channels[columns_.size() + v].name, raw_.times[row]),
                                     "choose another value, or leave this part of the record out");
                samples.values[columns_.size() + v][row] = results_[v];
            }
        }
        return true;
    }

private:
    ProcessedRecord record_;
    RecordHeader header_;
    std::vector<std::size_t> columns_;
    Function evaluate_;
    std::vector<double> inputs_, results_, work_;
    Samples raw_;
};

/// A source that ends when it is interrupted. It asks with each part that is read.
class InterruptedSource : public SampleSource {
public:
    InterruptedSource(std::unique_ptr<SampleSource> source, const std::function<bool()>& interrupted, bool& was)
        : source_(std::move(source)), interrupted_(&interrupted), was_(&was) {}
    const RecordHeader& header() const override { return source_->header(); }
    bool read(Samples& samples) override {
        if (*interrupted_ && (*interrupted_)()) {
            *was_ = true;
            samples.clear(header().channels.size());
            return false;
        }
        return source_->read(samples);
    }

private:
    std::unique_ptr<SampleSource> source_;
    const std::function<bool()>* interrupted_;
    bool* was_;
};

/// Takes the samples of one record.
class RecordSampler {
public:
    using Open = std::function<std::unique_ptr<SampleSource>()>;
    RecordSampler(const StudyRun& run, Open open) : run_(&run), request_(&run.record()), open_(std::move(open)) {
        first_ = request_->channels.size();
        set_.width = run.values.size();
    }

    void take(PointResult& result, std::vector<double>& coordinates) {
        read_rows(result);
        if (!request_->reference.empty())
            read_periods(result, coordinates);
        each_sampling([&](const RecordSampling& sampling, std::size_t index) {
            if (sampling.kind == RecordSampling::Kind::impacts)
                read_impacts(sampling, index);
        });
        result.samples = in_order();
    }

private:
    /// Calls `work` with each sampling and its index in the results, where impacts have two.
    template <class Work>
    void each_sampling(const Work& work) const {
        std::size_t index = 0;
        for (const RecordSampling& sampling : request_->samplings) {
            work(sampling, index);
            index += sampling.kind == RecordSampling::Kind::impacts ? 2 : 1;
        }
    }
    void add(std::size_t sampling, double time, std::span<const double> values) {
        if (set_.size() >= most_samples)
            throw InputError(fmt::format("more than {} samples would be kept", most_samples),
                             "take a part of the record, or make `keep` smaller");
        set_.samplings.push_back(sampling);
        set_.times.push_back(time);
        set_.values.insert(set_.values.end(), values.begin(), values.end());
    }
    std::size_t channel(const std::string& name) const { return header_.channel(name, "sample"); }

    /// Reads the duration and the last values of the record, and takes all rows if they are wanted and not too many.
    void read_rows(PointResult& result) {
        const auto source = open_();
        header_ = source->header();
        std::vector<std::size_t> wanted;
        each_sampling([&](const RecordSampling& sampling, std::size_t index) {
            if (sampling.kind == RecordSampling::Kind::record)
                wanted.push_back(index);
        });
        Samples samples;
        bool fits = true;
        double begin = 0;
        std::vector<double> row(set_.width);
        while (source->read(samples)) {
            if (rows_ == 0)
                begin = samples.times.front();
            rows_ += samples.rows();
            if (rows_ > request_->keep && fits) {
                fits = false;
                set_.clear();
            }
            for (std::size_t i = 0; fits && !wanted.empty() && i < samples.rows(); ++i) {
                for (std::size_t v = 0; v < row.size(); ++v)
                    row[v] = samples.values[first_ + v][i];
                for (const std::size_t sampling : wanted)
                    add(sampling, samples.times[i], row);
            }
            result.time = samples.times.back() - begin;
            result.outcome.time = samples.times.back();
            result.state.clear();
            for (std::size_t c = 0; c < first_; ++c)
                result.state.push_back(samples.values[c].back());
        }
        result.outcome.detail = fmt::format("{} rows{}", rows_, fits || wanted.empty() ? "" : ", which are not kept");
    }

    void read_periods(PointResult& result, std::vector<double>& coordinates) {
        const auto source = open_();
        PeriodSettings settings;
        settings.reference = header_.channel(request_->reference, "reference");
        settings.level = request_->level;
        settings.hysteresis = request_->hysteresis;
        const RecordPeriods found = each_period(*source, settings, [&](const Period& period) {
            each_sampling([&](const RecordSampling& sampling, std::size_t index) {
                if (sampling.is_periodic())
                    take_period(sampling, index, period);
            });
        });
        coordinates.push_back(found.amplitude);
        result.periods_run = result.cycles = found.count;
    }

    void take_period(const RecordSampling& sampling, std::size_t index, const Period& period) {
        using Kind = RecordSampling::Kind;
        if (sampling.kind == Kind::section) {
            RecordSymmetry symmetry;
            for (const std::string& name : sampling.negated)
                symmetry.negated.push_back(value_channel(name));
            return add_values(index, sampling.negated.empty() ? section(period, sampling.phase)
                                                              : image_section(period, sampling.phase, symmetry));
        }
        if (sampling.kind == Kind::maxima || sampling.kind == Kind::minima) {
            const Extremes found = extremes(period, channel(sampling.channel));
            const double time = sampling.kind == Kind::maxima ? found.greatest_time : found.least_time;
            return add_values(index, section(period, std::clamp((time - period.begin) / period.duration(), 0.0, 1.0)));
        }
        std::vector<double> row;
        for (std::size_t v = 0; v < set_.width; ++v)
            row.push_back(sampling.kind == Kind::amplitude ? amplitude(period, first_ + v)
                                                           : extremes(period, first_ + v).peak_to_peak());
        add(index, period.begin, row);
    }
    void add_values(std::size_t index, const SectionPoint& point) {
        add(index, point.time, std::span(point.values).subspan(first_, set_.width));
    }
    std::size_t value_channel(const std::string& name) const {
        const auto found = std::find(run_->value_names.begin(), run_->value_names.end(), name);
        return first_ + static_cast<std::size_t>(found - run_->value_names.begin());
    }

    /// Takes values at impacts, continued from the rows before each and from the rows after it.
    void read_impacts(const RecordSampling& sampling, std::size_t index) {
        const auto source = open_();
        const std::vector<RecordedImpact> impacts =
            find_impacts(*source, impact_settings(header_, sampling.channel, sampling.displacement, sampling.impacts));
        const auto again = open_();
        const auto of_values = [&](const std::vector<double>& row, double velocity) {
            std::vector<double> values(row.begin() + static_cast<std::ptrdiff_t>(first_), row.end());
            for (std::size_t v = 0; v < values.size(); ++v) // the velocity is known better than its continuation
                if (to_string(run_->values[v]) == sampling.channel || run_->value_names[v] == sampling.channel)
                    values[v] = velocity;
            return values;
        };
        for (const ImpactSides& sides : impact_sides(*again, impacts, sampling.impacts.transition)) {
            const RecordedImpact& impact = impacts[sides.impact];
            add(index, impact.time, of_values(sides.before, impact.before));
            add(index + 1, impact.time, of_values(sides.after, impact.after));
        }
    }

    /// The samples in the order of time.
    SampleSet in_order() const {
        std::vector<std::size_t> order(set_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return set_.times[a] < set_.times[b]; });
        SampleSet result;
        result.width = set_.width;
        for (const std::size_t i : order) {
            result.samplings.push_back(set_.samplings[i]);
            result.times.push_back(set_.times[i]);
            const double* values = set_.values.data() + i * set_.width;
            result.values.insert(result.values.end(), values, values + set_.width);
        }
        return result;
    }

    const StudyRun* run_;
    const RecordRequest* request_;
    Open open_;
    RecordHeader header_;
    std::size_t first_ = 0; ///< channel of the first value
    std::size_t rows_ = 0;
    SampleSet set_;
};

} // namespace

std::optional<PointRecord> RecordRun::point(std::size_t number, const std::function<bool()>& interrupted) {
    const StudyRun& run = *run_;
    const RecordRequest& request = run.record();
    PointRecord point;
    point.number = number;
    point.result.label = Label::ended;
    point.result.outcome.ending = Ending::end_time;
    std::string name;
    std::set<std::string> remarks; // a record is read more than once
    bool was_interrupted = false;
    std::function<std::unique_ptr<SampleSource>()> raw;
    std::optional<Samples> made;
    if (request.bench) {
        const std::size_t level = number % request.bench->levels.size();
        point.direction = request.bench->directions[level];
        name = fmt::format("{} = {:.10g}", request.bench->parameter, request.bench->levels[level]);
        if (request.bench->repeats > 1)
            name += fmt::format(" ({})", number / request.bench->levels.size() + 1);
        made = bench_->record(number, interrupted);
        if (!made)
            return std::nullopt;
        raw = [&] { return std::make_unique<StoredSamples>(bench_->header(), *made); };
    } else {
        const RecordInput& input = request.inputs[number];
        point.direction = input.direction;
        name = input.name;
        if (input.path.empty())
            throw InputError(run.place, fmt::format("the record '{}' is not among what the results keep", name),
                             "run the study file itself, beside its records");
        RecordInput now = input;
        fingerprint_record(now);
        if (now.hash != input.hash)
            throw InputError(Place{input.path, 0, 0}, "the record has changed since the study was read",
                             "run the study again");
        raw = [&input, &request, &remarks] {
            RecordLayout layout = request.processing.layout;
            layout.remark = [&remarks](const std::string& text) { remarks.insert(text); };
            return open_record(input.path, layout);
        };
    }
    const auto open = [&]() -> std::unique_ptr<SampleSource> {
        return std::make_unique<InterruptedSource>(std::make_unique<ValueSource>(raw(), run), interrupted,
                                                   was_interrupted);
    };
    try {
        RecordSampler(run, open).take(point.result, point.coordinates);
    } catch (const InputError& error) {
        if (was_interrupted) // what was read in part makes no sense
            return std::nullopt;
        const bool placed = error.place().line > 0;
        if (placed || (!request.bench && error.place().file == request.inputs[number].path))
            throw;
        throw InputError(request.bench ? run.place : Place{request.inputs[number].path, 0, 0},
                         (request.bench ? name + ": " : "") + error.problem(), error.remedy());
    }
    if (was_interrupted)
        return std::nullopt;
    point.result.outcome.detail = name + ": " + point.result.outcome.detail;
    for (const std::string& remark : remarks)
        point.result.outcome.detail += "; " + remark;
    return point;
}

} // namespace graze
