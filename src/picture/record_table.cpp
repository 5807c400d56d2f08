#include "graze/picture/record_table.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/record/impacts.hpp"
#include "graze/record/spectrum.hpp"
#include "picture/period_table.hpp"
#include "record/even_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace graze {

namespace {

constexpr std::size_t most_record_rows = 2'000'000;
constexpr std::size_t most_drawn = 4000; ///< pairs of least and greatest values of a curve

/// Thins a curve with more samples than can be distinguished: keeps the least and the greatest value of each part.
class CurveThinner {
public:
    void add(double time, double value) {
        if (points_.empty() || in_part_ == part_) {
            if (points_.size() >= 2 * most_drawn)
                halve();
            points_.push_back({{time, value}, {time, value}});
            in_part_ = 0;
        }
        ++in_part_;
        Pair& last = points_.back();
        if (value < last.least.y)
            last.least = {time, value};
        if (value > last.greatest.y)
            last.greatest = {time, value};
    }
    std::vector<PlanePoint> points() const {
        std::vector<PlanePoint> result;
        for (const Pair& pair : points_) {
            const bool rises = pair.least.x < pair.greatest.x;
            result.push_back(rises ? pair.least : pair.greatest);
            if (pair.least.x != pair.greatest.x)
                result.push_back(rises ? pair.greatest : pair.least);
        }
        return result;
    }

private:
    struct Pair {
        PlanePoint least, greatest;
    };
    void halve() {
        for (std::size_t i = 0; 2 * i + 1 < points_.size(); ++i) {
            const Pair &one = points_[2 * i], &other = points_[2 * i + 1];
            points_[i] = {one.least.y <= other.least.y ? one.least : other.least,
                          one.greatest.y >= other.greatest.y ? one.greatest : other.greatest};
        }
        points_.resize(points_.size() / 2);
        part_ *= 2;
    }
    std::vector<Pair> points_;
    std::size_t part_ = 1, in_part_ = 0;
};

/// The figure of channels over time, one panel each.
class Histories {
public:
    void add(const std::string& file, const RecordHeader& header, const std::vector<std::size_t>& channels,
             const Samples& samples) {
        time_ = header.time;
        for (const std::size_t c : channels) {
            const Channel& channel = header.channels[c];
            if (!curves_.contains(channel.name))
                order_.push_back(channel);
            CurveThinner& curve = curves_[channel.name][file];
            for (std::size_t i = 0; i < samples.rows(); ++i)
                curve.add(samples.times[i], samples.values[c][i]);
        }
    }
    Figure figure(bool titled) const {
        Figure figure;
        for (const Channel& channel : order_) {
            FigurePanel panel;
            label_x(panel, time_);
            label_y(panel, channel);
            panel.roomy_y = true;
            for (const auto& [file, curve] : curves_.at(channel.name))
                panel.series.push_back(
                    {titled ? file : "", FigureSeries::Style::line, panel.series.size(), curve.points()});
            figure.panels.push_back(std::move(panel));
        }
        return figure;
    }

private:
    Channel time_;
    std::vector<Channel> order_;
    std::map<std::string, std::map<std::string, CurveThinner>> curves_;
};

/// Statistics of each channel.
class ChannelTable : public RecordTable {
public:
    ChannelTable(const RecordTableRequest& request, bool several) : RecordTable(request, several) {}
    void add(const std::string& file, ProcessedRecord& record) override {
        const RecordHeader& header = record.header();
        const std::vector<std::size_t> channels = channels_of(header);
        begin({{"channel", ""},
               {"unit", ""},
               {"least", ""},
               {"greatest", ""},
               {"mean", ""},
               {"deviation", ""},
               {"samples", ""},
               {"begin", header.time.unit},
               {"end", header.time.unit},
               {"shortest_step", header.time.unit},
               {"longest_step", header.time.unit}});
        std::vector<Numbers> numbers(channels.size());
        Numbers steps;
        double first = 0, last = 0, count = 0;
        Samples samples;
        while (record.source().read(samples)) {
            if (count == 0)
                first = last = samples.times.front();
            for (std::size_t i = 0; i < samples.rows(); last = samples.times[i++], ++count)
                if (count > 0)
                    steps.add(samples.times[i] - last);
            for (std::size_t c = 0; c < channels.size(); ++c)
                for (const double value : samples.values[channels[c]])
                    numbers[c].add(value);
            if (request().drawn)
                histories_.add(file, header, channels, samples);
        }
        for (std::size_t c = 0; c < channels.size(); ++c) {
            begin_row(file);
            rows().add(header.channels[channels[c]].name, header.channels[channels[c]].unit);
            numbers[c].put(rows());
            rows().add(count, count > 0 ? first : not_a_number, count > 0 ? last : not_a_number,
                       count > 1 ? steps.least : not_a_number, count > 1 ? steps.greatest : not_a_number);
        }
    }
    Figure figure() const override { return histories_.figure(several()); }

private:
    struct Numbers {
        double least = 0, greatest = 0, count = 0, mean = 0, squares = 0;
        void add(double value) {
            least = count == 0 ? value : std::min(least, value);
            greatest = count == 0 ? value : std::max(greatest, value);
            const double before = value - mean;
            mean += before / ++count;
            squares += before * (value - mean);
        }
        void put(Table& table) const {
            for (const double value : {least, greatest, mean})
                table.add(count > 0 ? value : not_a_number);
            table.add(count > 1 ? std::sqrt(squares / (count - 1)) : not_a_number);
        }
    };
    Histories histories_;
};

/// All rows of the records.
class SampleTable : public RecordTable {
public:
    SampleTable(const RecordTableRequest& request, bool several) : RecordTable(request, several) {}
    void add(const std::string& file, ProcessedRecord& record) override {
        const RecordHeader& header = record.header();
        const std::vector<std::size_t> channels = channels_of(header);
        std::vector<Table::Column> columns{{header.time.name, header.time.unit}};
        for (const std::size_t c : channels)
            columns.push_back({header.channels[c].name, header.channels[c].unit});
        begin(columns);
        Samples samples;
        while (record.source().read(samples)) {
            if (request().drawn) {
                histories_.add(file, header, channels, samples);
                continue;
            }
            require_few_rows(rows());
            for (std::size_t i = 0; i < samples.rows(); ++i) {
                begin_row(file);
                rows().add(samples.times[i]);
                for (const std::size_t c : channels)
                    rows().add(samples.values[c][i]);
            }
        }
    }
    Figure figure() const override { return histories_.figure(several()); }

private:
    Histories histories_;
};

class SpectrumTable : public RecordTable {
public:
    SpectrumTable(const RecordTableRequest& request, bool several) : RecordTable(request, several) {}
    void add(const std::string& file, ProcessedRecord& record) override {
        const RecordHeader header = record.header();
        const std::size_t which = only_channel(header, "a spectrum is that of one channel");
        const Channel& channel = header.channels[which];
        begin({{"frequency", inverse(header.time.unit)}, {"amplitude", channel.unit}});
        Spectrum found;
        if (request().part > 0) {
            found = averaged_spectrum(record.source(), which, request().part, request().interrupted);
        } else {
            constexpr std::size_t most = 4'000'000;
            const Samples all = read_all(record.source(), most);
            found = spectrum(all.values[which], even_sampling_frequency(all.times), request().interrupted);
        }
        FigureSeries series{several() ? file : "", FigureSeries::Style::line, panel_.series.size()};
        for (std::size_t k = 0; k < found.frequencies.size(); ++k) {
            begin_row(file);
            rows().add(found.frequencies[k], found.amplitudes[k]);
            series.points.push_back({found.frequencies[k], found.amplitudes[k]});
        }
        label_x(panel_, {"frequency", inverse(header.time.unit)});
        label_y(panel_, {"amplitude of " + channel.name, channel.unit});
        panel_.series.push_back(std::move(series));
    }
    Figure figure() const override { return {.panels = {panel_}}; }

private:
    static std::string inverse(const std::string& unit) {
        return unit.empty() ? "" : unit == "s" ? "Hz" : unit == "ms" ? "kHz" : "1/" + unit;
    }
    FigurePanel panel_;
};

class ImpactTable : public RecordTable {
public:
    ImpactTable(const RecordTableRequest& request, bool several) : RecordTable(request, several) {}
    void add(const std::string& file, ProcessedRecord& record) override {
        const RecordHeader header = record.header();
        velocity_ = header.channels[only_channel(header, "impacts are jumps of one channel, a velocity")];
        begin({{"time", header.time.unit},
               {"time_error", header.time.unit},
               {"before", velocity_.unit},
               {"before_error", velocity_.unit},
               {"after", velocity_.unit},
               {"after_error", velocity_.unit},
               {"ratio", ""}});
        ImpactFinder finder(borrowed(record.source()),
                            impact_settings(header, velocity_.name, request().displacement, request().impacts));
        std::vector<RecordedImpact> impacts;
        while (finder.next(impacts))
            for (const RecordedImpact& impact : impacts) {
                begin_row(file);
                rows().add(impact.time, impact.time_error, impact.before, impact.before_error, impact.after,
                           impact.after_error, -impact.after / impact.before);
            }
    }
    /// Velocities after impacts over velocities before.
    Figure figure() const override {
        FigureSeries series{.style = FigureSeries::Style::circles};
        const std::size_t before = several() ? 3 : 2;
        for (std::size_t row = 0; row < table().rows(); ++row)
            series.points.push_back({table().number(row, before), table().number(row, before + 2)});
        return {.panels = {{.x_label = velocity_.name + " before an impact",
                            .y_label = velocity_.name + " after it",
                            .x_unit = velocity_.unit,
                            .y_unit = velocity_.unit,
                            .roomy_y = true,
                            .roomy_x = true,
                            .series = {std::move(series)}}}};
    }

private:
    Channel velocity_;
};

} // namespace

std::vector<std::string> record_table_names() {
    return {"channels", "samples", "periods", "sections", "extremes", "spectrum", "impacts"};
}

void RecordTable::begin(const std::vector<Table::Column>& columns) {
    std::vector<Table::Column> all = columns;
    if (several_)
        all.insert(all.begin(), {"file", ""});
    if (!begun_)
        table_ = Table(all);
    else if (!std::equal(all.begin(), all.end(), table_.columns().begin(), table_.columns().end(),
                         [](const Table::Column& one, const Table::Column& other) {
                             return one.name == other.name && one.unit == other.unit;
                         }))
        throw InputError("this record has other channels or units than those before",
                         "look at records of one kind together, or choose channel that all of them have");
    begun_ = true;
}

void RecordTable::begin_row(const std::string& file) {
    if (several_)
        table_.add(file);
}

void label_x(FigurePanel& panel, const Channel& channel) {
    panel.x_label = channel.name;
    panel.x_unit = channel.unit;
}

void label_y(FigurePanel& panel, const Channel& channel) {
    panel.y_label = channel.name;
    panel.y_unit = channel.unit;
}

void require_few_rows(const Table& table) {
    if (table.rows() > most_record_rows)
        throw InputError(fmt::format("the table has more than {} rows", most_record_rows),
                         "write the record to a file by write, or take a part of it by from and to");
}

std::size_t RecordTable::only_channel(const RecordHeader& header, const char* problem) const {
    const std::vector<std::size_t> channels = channels_of(header);
    if (channels.size() != 1)
        throw InputError(problem, "name it by channel");
    return channels.front();
}

std::unique_ptr<RecordTable> record_table(const RecordTableRequest& request, bool several) {
    using What = RecordTableRequest::What;
    if (request.what == What::channels)
        return std::make_unique<ChannelTable>(request, several);
    if (request.what == What::samples)
        return std::make_unique<SampleTable>(request, several);
    if (request.what == What::spectrum)
        return std::make_unique<SpectrumTable>(request, several);
    if (request.what == What::impacts)
        return std::make_unique<ImpactTable>(request, several);
    if (request.reference.empty())
        throw InputError(fmt::format("nothing says what begins the periods of which {} are asked for",
                                     record_table_names()[static_cast<std::size_t>(request.what)]),
                         "name the channel of the input by reference");
    return period_table(request, several);
}

} // namespace graze
