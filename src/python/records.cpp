#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/picture/record_table.hpp"
#include "graze/picture/residual_figure.hpp"
#include "graze/record/harmonic.hpp"
#include "graze/record/record_writer.hpp"
#include "graze/study/identify_records.hpp"
#include "python/attended.hpp"
#include "python/figures.hpp"
#include "python/noted.hpp"
#include "python/tables.hpp"
#include "python/words.hpp"

#include <algorithm>
#include <functional>
#include <limits>

namespace graze::python {

namespace {

/// Ends reading, in a computation that has to end: `attended` throws what has ended it.
class Ended : public std::exception {};

/// Passes samples on until the computation has to end.
class StoppableSource : public SampleSource {
public:
    StoppableSource(std::shared_ptr<SampleSource> source, MustStop must_stop)
        : source_(std::move(source)), must_stop_(std::move(must_stop)) {}
    const RecordHeader& header() const override { return source_->header(); }
    bool read(Samples& samples) override {
        if (must_stop_())
            throw Ended();
        return source_->read(samples);
    }

private:
    std::shared_ptr<SampleSource> source_;
    MustStop must_stop_;
};

/// A source that keeps its processing alive.
std::shared_ptr<SampleSource> source_of(std::shared_ptr<SampleSource> source, const RecordProcessing& processing) {
    const auto record = std::make_shared<ProcessedRecord>(std::move(source), processing);
    return {record, &record->source()};
}

/// Remarks on what was left out of a file, each once.
using Remarks = Noted<std::vector<std::string>>;

/// A record that can be read as often as wanted, from a file or from memory, with its processing.
class HeldRecord {
public:
    using Open = std::function<std::shared_ptr<SampleSource>()>;
    HeldRecord(std::string name, Open open, std::shared_ptr<Remarks> remarks)
        : name_(std::move(name)), open_(std::move(open)), remarks_(std::move(remarks)) {
        header_ = opened()->header();
    }

    const std::string& name() const { return name_; }
    const RecordHeader& header() const { return header_; }
    std::vector<std::string> remarks() const { return remarks_->now(); }
    std::shared_ptr<SampleSource> opened() const { return with_place({name_, 0, 0}, open_); }
    std::shared_ptr<SampleSource> opened(const MustStop& must_stop) const {
        return std::make_shared<StoppableSource>(opened(), must_stop);
    }
    std::shared_ptr<HeldRecord> processed(const RecordProcessing& processing) const {
        return std::make_shared<HeldRecord>(
            name_, [open = open_, processing] { return source_of(open(), processing); }, remarks_);
    }

private:
    std::string name_;
    Open open_;
    std::shared_ptr<Remarks> remarks_;
    RecordHeader header_;
};

using HeldRecords = std::vector<std::shared_ptr<HeldRecord>>;

/// Does something with a record that is opened for it, in a thread of its own.
void attend_record(const HeldRecord& record, const std::function<void(SampleSource&, const MustStop&)>& work) {
    attended([&](const MustStop& must_stop) {
        const auto source = record.opened(must_stop);
        with_place({record.name(), 0, 0}, [&] { work(*source, must_stop); });
    });
}

std::shared_ptr<HeldRecord> record_of_file(const std::string& path, const py::dict& words) {
    RecordLayout layout;
    read_word(words, "columns", layout.columns);
    read_word(words, "group", layout.group);
    read_word(words, "skip", layout.skip);
    read_word(words, "names_line", layout.names_line);
    read_word(words, "units_line", layout.units_line);
    const auto remarks = std::make_shared<Remarks>();
    layout.remark = [remarks](const std::string& text) {
        remarks->change([&](std::vector<std::string>& texts) {
            if (std::ranges::find(texts, text) == texts.end())
                texts.push_back(text);
        });
    };
    const auto open = [path, layout] { return std::shared_ptr<SampleSource>(open_record(path, layout)); };
    return std::make_shared<HeldRecord>(path, open, remarks);
}

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::vector<double> numbers_of(const Numbers& array, const std::string& name) {
    if (array.ndim() != 1)
        throw InputError(name + " has " + std::to_string(array.ndim()) + " axes", "give numbers along one axis");
    return {array.data(), array.data() + array.size()};
}

std::shared_ptr<HeldRecord> record_of_arrays(const std::string& name, const Channel& time, const Numbers& times,
                                             const std::vector<Channel>& channels, const std::vector<Numbers>& values) {
    Samples samples;
    samples.times = numbers_of(times, "time");
    for (std::size_t i = 0; i < channels.size(); ++i) {
        samples.values.push_back(numbers_of(values[i], channels[i].name));
        if (samples.values.back().size() != samples.times.size())
            throw InputError(channels[i].name + " has " + std::to_string(samples.values.back().size()) +
                                 " samples, and there are " + std::to_string(samples.times.size()) + " times",
                             "give one for each time");
    }
    const auto record = std::make_shared<const StoredSamples>(RecordHeader{time, channels}, std::move(samples));
    return std::make_shared<HeldRecord>(
        name, [record] { return std::shared_ptr<SampleSource>(record->again()); }, std::make_shared<Remarks>());
}

RecordProcessing processing_from(const py::dict& words) {
    RecordProcessing processing;
    read_word(words, "from", processing.begin);
    read_word(words, "to", processing.end);
    read_word(words, "pass", processing.pass);
    read_word(words, "stop", processing.stop);
    read_word(words, "every", processing.every);
    read_word(words, "derivative", processing.derivative);
    read_word(words, "half_width", processing.half_width);
    if (words.contains("scale"))
        for (const auto& [channel, factor, offset, unit] :
             words["scale"].cast<std::vector<std::tuple<std::string, double, double, std::optional<std::string>>>>())
            processing.scales.push_back({channel, factor, offset, unit});
    return processing;
}

void read_window(const py::dict& words, ImpactWindow& window) {
    read_word(words, "window", window.window);
    read_word(words, "transition", window.transition);
    read_word(words, "least_jump", window.least_jump);
}

RecordTableRequest table_request_from(const std::string& what, const py::dict& words) {
    RecordTableRequest request;
    const std::vector<std::string> names = record_table_names();
    const auto known = std::ranges::find(names, what);
    if (known == names.end())
        throw InputError("there is no table '" + what + "' of records",
                         "use channels, samples, periods, sections, extremes, spectrum or impacts");
    request.what = static_cast<RecordTableRequest::What>(known - names.begin());
    read_word(words, "channels", request.channels);
    read_word(words, "reference", request.reference);
    read_word(words, "level", request.level);
    read_word(words, "hysteresis", request.hysteresis);
    read_word(words, "phases", request.phases);
    read_word(words, "negate", request.negated);
    read_word(words, "displacement", request.displacement);
    read_word(words, "part", request.part);
    read_window(words, request.impacts);
    return request;
}

std::unique_ptr<RecordTable> filled_table(const HeldRecords& records, RecordTableRequest request, bool drawn) {
    request.drawn = drawn;
    std::unique_ptr<RecordTable> table;
    attended([&](const MustStop& must_stop) {
        request.interrupted = must_stop;
        table = record_table(request, records.size() > 1);
        for (const auto& one : records)
            with_place({one->name(), 0, 0}, [&] {
                ProcessedRecord record(one->opened(must_stop), {});
                table->add(one->name(), record);
            });
    });
    return table;
}

/// All samples: columns for the time and each channel.
py::tuple samples_of(const HeldRecord& record) {
    constexpr std::size_t most = 1'000'000'000;
    Samples samples;
    attend_record(record, [&](SampleSource& source, const MustStop&) { samples = read_all(source, most); });
    std::vector<std::string> names{record.header().time.name}, units{record.header().time.unit};
    py::list columns;
    columns.append(array_of(std::move(samples.times)));
    for (std::size_t i = 0; i < samples.values.size(); ++i) {
        names.push_back(record.header().channels[i].name);
        units.push_back(record.header().channels[i].unit);
        columns.append(array_of(std::move(samples.values[i])));
    }
    return py::make_tuple(names, columns, units);
}

py::dict period_of(const HeldRecord& record, const std::string& reference, double level, double hysteresis) {
    PeriodFit fit;
    RecordPeriods periods;
    attend_record(record, [&](SampleSource& source, const MustStop&) {
        std::vector<double> crossings;
        periods = each_period(source, {record.header().channel(reference, "reference"), level, hysteresis},
                              [&](const Period& period) {
                                  if (crossings.empty())
                                      crossings.push_back(period.begin);
                                  crossings.push_back(period.end);
                              });
        fit = fit_period(crossings);
    });
    py::dict object;
    object["period"] = fit.period;
    object["error"] = fit.period_error;
    object["begin"] = fit.begin;
    object["begin_error"] = fit.begin_error;
    object["jitter"] = fit.jitter;
    object["periods"] = periods.count;
    object["amplitude"] = periods.amplitude;
    return object;
}

py::dict harmonic_of(const HeldRecord& record, const std::string& channel, double frequency) {
    Harmonic fit;
    attend_record(record, [&](SampleSource& source, const MustStop&) {
        constexpr std::size_t most = 100'000'000;
        const std::size_t index = record.header().channel(channel, "channel");
        const Samples samples = read_all(source, most);
        fit = fit_harmonic(samples.times, samples.values[index], frequency);
    });
    py::dict object;
    object["frequency"] = fit.frequency;
    object["offset"] = fit.offset;
    object["offset_error"] = fit.offset_error;
    object["sine"] = fit.sine;
    object["sine_error"] = fit.sine_error;
    object["cosine"] = fit.cosine;
    object["cosine_error"] = fit.cosine_error;
    object["covariance"] = fit.covariance;
    object["amplitude"] = fit.amplitude();
    object["amplitude_error"] = fit.amplitude_error();
    object["phase"] = fit.phase();
    object["phase_error"] = fit.phase_error();
    object["noise"] = fit.noise;
    object["samples"] = fit.samples;
    return object;
}

void write_record(const HeldRecord& record, const std::string& path, const std::vector<std::string>& channels) {
    const std::vector<std::size_t> chosen = record.header().chosen_channels(channels, "channels");
    attend_record(record, [&](SampleSource& source, const MustStop& must_stop) {
        write_record(source, chosen, path, must_stop);
    });
}

IdentifyRequest identify_request_from(const std::string& what, const py::dict& words) {
    IdentifyRequest request;
    const std::vector<std::string>& kinds = kinds_of_estimates();
    const auto known = std::ranges::find(kinds, what);
    if (known == kinds.end())
        throw InternalError("there is no estimate '" + what + "'");
    request.what = static_cast<IdentifyRequest::What>(known - kinds.begin());
    read_word(words, "channel", request.channel);
    read_word(words, "displacement", request.displacement);
    read_word(words, "voltage", request.voltage);
    read_word(words, "current", request.current);
    read_word(words, "peaks", request.peaks);
    read_window(words, request.impacts);
    read_word(words, "gap", request.gap);
    read_word(words, "gap_error", request.gap_error);
    read_word(words, "stiffness", request.stiffness);
    read_word(words, "stiffness_error", request.stiffness_error);
    read_word(words, "beta1", request.beta1);
    read_word(words, "beta1_error", request.beta1_error);
    read_word(words, "beta2", request.beta2);
    read_word(words, "beta2_error", request.beta2_error);
    read_word(words, "clamped", request.clamped);
    read_word(words, "frequency", request.frequency);
    read_word(words, "displacement_noise", request.displacement_noise);
    read_word(words, "current_noise", request.current_noise);
    request.each_row = true;
    return request;
}

/// The estimates, and the figure of the residuals.
py::tuple identified(const HeldRecords& records, const std::string& what, const py::dict& words) {
    StudyRun run(RunKind::identify);
    run.identify() = identify_request_from(what, words);
    Identification found;
    Figure figure;
    attended([&](const MustStop& must_stop) {
        const EachRecord each = [&](const auto& work) {
            for (const auto& one : records)
                with_place({one->name(), 0, 0}, [&] {
                    ProcessedRecord record(one->opened(must_stop), {});
                    work(one->name(), record.source());
                });
        };
        found = identify_records(run, each, records.size());
        figure = residual_figure(found);
    });
    py::list values;
    for (const Identification::Value& value : found.values)
        values.append(py::make_tuple(value.name, value.unit, value.estimate.value, value.estimate.error,
                                     value.estimate.freedom, value.estimate.half_width()));
    const auto count = static_cast<py::ssize_t>(found.values.size());
    const bool known = found.covariance.size() == found.values.size() * found.values.size();
    return py::make_tuple(
        values, known ? py::object(array_of(std::move(found.covariance), {count, count})) : py::object(py::none()),
        found.warnings, object_of(std::move(figure)));
}

Channel channel_from(const std::pair<std::string, std::string>& name_and_unit) {
    return {name_and_unit.first, name_and_unit.second};
}

} // namespace

void bind_records(py::module_& module) {
    py::class_<HeldRecord, std::shared_ptr<HeldRecord>>(module, "Record")
        .def_static("opened", &record_of_file, py::arg("path"), py::arg("layout"))
        .def_static(
            "of_arrays",
            [](const std::string& name, const std::pair<std::string, std::string>& time, const Numbers& times,
               const std::vector<std::pair<std::string, std::string>>& channels, const std::vector<Numbers>& values) {
                std::vector<Channel> named;
                for (const auto& one : channels)
                    named.push_back(channel_from(one));
                return record_of_arrays(name, channel_from(time), times, named, values);
            },
            py::arg("name"), py::arg("time"), py::arg("times"), py::arg("channels"), py::arg("values"))
        .def_property_readonly("name", &HeldRecord::name)
        .def_property_readonly(
            "time",
            [](const HeldRecord& self) { return py::make_tuple(self.header().time.name, self.header().time.unit); })
        .def_property_readonly("channels",
                               [](const HeldRecord& self) {
                                   py::list list;
                                   for (const Channel& one : self.header().channels)
                                       list.append(py::make_tuple(one.name, one.unit));
                                   return list;
                               })
        .def_property_readonly("remarks", &HeldRecord::remarks)
        .def("processed",
             [](const HeldRecord& self, const py::dict& words) { return self.processed(processing_from(words)); })
        .def("samples", &samples_of)
        .def("period", &period_of, py::arg("reference"), py::arg("level"), py::arg("hysteresis"))
        .def("harmonic", &harmonic_of, py::arg("channel"), py::arg("frequency"))
        .def("write", &write_record, py::arg("path"), py::arg("channels"));
    module.def(
        "record_table",
        [](const HeldRecords& records, const std::string& what, const py::dict& words) {
            return columns_of(filled_table(records, table_request_from(what, words), false)->table());
        },
        py::arg("records"), py::arg("what"), py::arg("words"));
    module.def(
        "record_figure",
        [](const HeldRecords& records, const std::string& what, const py::dict& words) {
            return object_of(filled_table(records, table_request_from(what, words), true)->figure());
        },
        py::arg("records"), py::arg("what"), py::arg("words"));
    module.def("identified", &identified, py::arg("records"), py::arg("what"), py::arg("words"));
}

} // namespace graze::python
